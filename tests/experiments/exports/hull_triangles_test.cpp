#include "experiments/exports/hull_triangles.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <random>
#include <set>

namespace possibility::experiments {
namespace {

using Eigen::Vector3d;

/// By the divergence theorem: right only for a closed surface that is covered once, outward.
double EnclosedVolume(const std::vector<Vector3d>& points) {
  double volume = 0;
  for (const auto& [a, b, c] : HullTriangles(points)) {
    volume += points[a].dot(points[b].cross(points[c])) / 6;
  }
  return volume;
}

TEST(HullTrianglesTest, EncloseABoxWithPointsInside) {
  std::vector<Vector3d> points;
  for (const double x : {0.0, 2.0}) {
    for (const double y : {1.0, 4.0}) {
      for (const double z : {-1.0, 0.0}) points.emplace_back(x, y, z);
    }
  }
  EXPECT_NEAR(EnclosedVolume(points), 6, 1e-12);
  points.emplace_back(1, 2, -0.5);  // inside
  points.emplace_back(1, 2, 0);     // on a face
  points.emplace_back(1, 1, 0);     // on an edge
  points.push_back(points[0]);      // twice
  EXPECT_NEAR(EnclosedVolume(points), 6, 1e-12);
  EXPECT_EQ(HullTriangles(points).size(), 12u);
}

TEST(HullTrianglesTest, EncloseTheWholeOfRandomPoints) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<Vector3d> points;
  for (int i = 0; i < 20; ++i)
    points.emplace_back(uniform(random), uniform(random), uniform(random));
  const auto triangles = HullTriangles(points);
  for (const auto& [a, b, c] : triangles) {
    const Vector3d normal = Vector3d(points[b] - points[a]).cross(Vector3d(points[c] - points[a]));
    for (const Vector3d& point : points) EXPECT_LT(normal.dot(point - points[a]), 1e-12);
  }
  // Euler: a closed surface of triangles around v corners has 2 v - 4 of them.
  std::set<int> corners;
  for (const auto& triangle : triangles) corners.insert(triangle.begin(), triangle.end());
  EXPECT_EQ(triangles.size(), 2 * corners.size() - 4);
}

TEST(HullTrianglesTest, FlatPointsHaveNone) {
  EXPECT_TRUE(HullTriangles({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}).empty());
  EXPECT_TRUE(HullTriangles({}).empty());
}

}  // namespace
}  // namespace possibility::experiments
