#include "models/shapes/convex_hull.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <utility>

#include "models/input/input_error.h"
#include "tests/message_of.h"
#include "tests/models/random_geometry.h"

namespace possibility::models {
namespace {

using Eigen::Vector3d;
using testing::RandomGeometry;

/// Every edge has one facet on each side, no corner is outside, and Euler's formula holds.
void ExpectConvexAndClosed(const ConvexHull& hull, double slack) {
  std::map<std::pair<int, int>, int> sides;
  for (const auto& facet : hull.facets) {
    for (int i = 0; i < 3; ++i) ++sides[{facet[i], facet[(i + 1) % 3]}];
  }
  for (const auto& [side, count] : sides) {
    EXPECT_EQ(count, 1);
    EXPECT_TRUE(sides.contains({side.second, side.first}));
  }
  EXPECT_EQ(hull.vertices.size() + hull.facets.size(), sides.size() / 2 + 2);
  for (const Vector3d& vertex : hull.vertices) EXPECT_LE(hull.Outside(vertex), slack);
}

TEST(ConvexHullTest, RandomPointsAreInsideAndCornersAreAmongThem) {
  RandomGeometry random(11);
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<Vector3d> points(4 + random.Index(300));
    const Vector3d stretch(random.Uniform(0.01, 2), random.Uniform(0.01, 2), random.Uniform(1, 2));
    for (Vector3d& p : points) {
      p = random.Direction().cwiseProduct(stretch) * std::cbrt(random.Uniform(0, 1)) +
          Vector3d(3, -4, 5);
    }
    const ConvexHull hull = HullOfPoints(points);
    ExpectConvexAndClosed(hull, 1e-8);
    for (const Vector3d& p : points) EXPECT_LE(hull.Outside(p), 1e-8);
    for (const Vector3d& vertex : hull.vertices) {
      EXPECT_NE(std::find(points.begin(), points.end(), vertex), points.end());
    }
    // A corner is the farthest point in some direction: no other hull has it outside.
    for (std::size_t v = 0; v < hull.vertices.size() && hull.vertices.size() > 5; ++v) {
      std::vector<Vector3d> others = hull.vertices;
      others.erase(others.begin() + v);
      EXPECT_GT(HullOfPoints(others).Outside(hull.vertices[v]), 0);
    }
  }
}

TEST(ConvexHullTest, ABoxFullOfGridPointsHasItsVolumeAndEightCorners) {
  RandomGeometry random(12);
  for (int trial = 0; trial < 20; ++trial) {
    const Eigen::Isometry3d X = trial == 0 ? Eigen::Isometry3d::Identity() : random.Pose(1);
    std::vector<Vector3d> points;
    for (int i = 0; i < 5 * 6 * 7; ++i) {
      points.push_back(X * Vector3d(0.1 * (i % 5), 0.2 * (i / 5 % 6), 0.05 * (i / 30)));
    }
    const ConvexHull hull = HullOfPoints(points);
    EXPECT_NEAR(hull.Volume(), 0.4 * 1.0 * 0.3, 1e-9);
    EXPECT_LT((hull.Centroid() - X * Vector3d(0.2, 0.5, 0.15)).norm(), 1e-9);
    const Eigen::Matrix3d spread =
        X.linear() * Vector3d(0.16, 1, 0.09).asDiagonal() * X.linear().transpose() / 12;
    EXPECT_LT((hull.Covariance() - spread).norm(), 1e-9);
    for (const Vector3d& p : points) EXPECT_LE(hull.Outside(p), 1e-8);
    if (trial == 0) {
      EXPECT_EQ(hull.vertices.size(), 8u);
    }
  }
}

TEST(ConvexHullTest, SolidsHaveTheirVolumes) {
  EXPECT_NEAR(HullOfPoints({{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 3}}).Volume(), 1, 1e-12);
  EXPECT_NEAR(
      HullOfPoints({{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}).Volume(),
      4.0 / 3, 1e-12);
  // A prism over a regular polygon of n corners: n/2 sin(2 pi / n) times its height.
  constexpr int kCorners = 48;
  std::vector<Vector3d> prism;
  for (int i = 0; i < 2 * kCorners; ++i) {
    const double angle = 2 * std::numbers::pi * (i / 2) / kCorners;
    prism.emplace_back(std::cos(angle), std::sin(angle), 0.5 * (i % 2));
  }
  const ConvexHull hull = HullOfPoints(prism);
  EXPECT_EQ(hull.vertices.size(), prism.size());
  EXPECT_NEAR(hull.Volume(), 0.5 * kCorners / 2 * std::sin(2 * std::numbers::pi / kCorners), 1e-9);
}

TEST(ConvexHullTest, ASphereOfPointsHasNearlyTheVolumeOfTheBall) {
  RandomGeometry random(13);
  std::vector<Vector3d> points(3000);
  for (Vector3d& p : points) p = random.Direction();
  const ConvexHull hull = HullOfPoints(points);
  EXPECT_EQ(hull.vertices.size(), points.size());
  ExpectConvexAndClosed(hull, 1e-9);
  const double ball = 4 * std::numbers::pi / 3;
  EXPECT_LT(hull.Volume(), ball);
  EXPECT_GT(hull.Volume(), 0.99 * ball);
}

TEST(ConvexHullTest, ASimpleHullHasFewCornersAndContainsAllPoints) {
  RandomGeometry random(14);
  for (const int most : {4, 8, 20, 64}) {
    std::vector<Vector3d> points(1000);
    for (Vector3d& p : points) p = random.Direction().cwiseProduct(Vector3d(0.1, 0.2, 0.3));
    const ConvexHull simple = SimpleHullOfPoints(points, most);
    EXPECT_LE(static_cast<int>(simple.vertices.size()), most);
    ExpectConvexAndClosed(simple, 1e-9);
    for (const Vector3d& p : points) EXPECT_LE(simple.Outside(p), 1e-9);
    if (most == 64) {
      EXPECT_LT(simple.Volume(), 1.25 * HullOfPoints(points).Volume());
    }
  }
}

TEST(ConvexHullTest, ASimpleHullOfFewPointsIsExact) {
  const std::vector<Vector3d> points = {
      {0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 3}, {0.1, 0.1, 0.1}};
  EXPECT_NEAR(SimpleHullOfPoints(points, 4).Volume(), 1, 1e-12);
}

TEST(ConvexHullTest, PointsWithoutABodyAreRefused) {
  const std::string flat = "convex hull: the points lie in one plane, expected a body";
  const auto error = [](const std::vector<Vector3d>& points) {
    return MessageOf<InputError>([&] { HullOfPoints(points); });
  };
  EXPECT_EQ(error({}), flat);
  EXPECT_EQ(error({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}), flat);
  EXPECT_EQ(error({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}}), flat);
  EXPECT_EQ(error({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}, {4, 4, 4}}), flat);
  EXPECT_EQ(error({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0.5, 0.5, 1e-8}}), flat);
  EXPECT_EQ(error({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, std::nan("")}}),
            "convex hull: a point is not finite");
}

}  // namespace
}  // namespace possibility::models
