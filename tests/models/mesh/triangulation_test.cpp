#include "models/mesh/triangulation.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <vector>

#include "tests/models/random_geometry.h"

namespace possibility::models {
namespace {

using Eigen::Vector3d;

/// A star about the origin: a corner in each of random directions, at random distances.
std::vector<Vector3d> StarPolygon(int corners, testing::RandomGeometry* random) {
  std::vector<double> angles;
  for (int i = 0; i < corners; ++i) {
    angles.push_back(2 * M_PI * (i + random->Uniform(0.1, 0.9)) / corners);
  }
  std::vector<Vector3d> star;
  for (const double angle : angles) {
    star.push_back(random->Uniform(0.2, 1) * Vector3d(std::cos(angle), std::sin(angle), 0));
  }
  return star;
}

TEST(Triangulation, StarsAreCoveredOnceWithTheSameSense) {
  testing::RandomGeometry random(4);
  for (int round = 0; round < 200; ++round) {
    const std::vector<Vector3d> star = StarPolygon(4 + random.Index(30), &random);
    const Eigen::Isometry3d X = random.Pose(3);
    std::vector<Vector3d> corners;
    for (const Vector3d& p : star) corners.push_back(X * p);
    const auto triangles = Triangulated(corners);
    ASSERT_EQ(triangles.size(), corners.size() - 2);
    // Seen from its middle, a star's area is the sum over its sides.
    double expected = 0, found = 0;
    for (std::size_t i = 0; i < star.size(); ++i) {
      expected += star[i].cross(star[(i + 1) % star.size()]).z() / 2;
    }
    for (const auto& [a, b, c] : triangles) {
      const Vector3d area = (corners[b] - corners[a]).cross(corners[c] - corners[a]) / 2;
      EXPECT_GE(area.dot(X.linear().col(2)), 0);
      found += area.norm();
    }
    EXPECT_NEAR(found, expected, 1e-9);
  }
}

TEST(Triangulation, PolygonsWithoutEarsEndToo) {
  EXPECT_TRUE(Triangulated({{0, 0, 0}, {1, 0, 0}}).empty());
  const std::vector<Vector3d> crossed = {{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}};
  EXPECT_EQ(Triangulated(crossed).size(), 2u);
  EXPECT_EQ(Triangulated(std::vector<Vector3d>(7, Vector3d::Zero())).size(), 5u);
}

}  // namespace
}  // namespace possibility::models
