#include "models/facts/sole.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "models/mesh/convex_merge.h"
#include "tests/models/random_geometry.h"

namespace possibility::models {
namespace {

using Eigen::Vector3d;

Link With(const Shape& shape, const Eigen::Isometry3d& X = Eigen::Isometry3d::Identity()) {
  Link link;
  link.shapes = {{shape, X}};
  return link;
}

TEST(SoleTest, ABoxStandsOnItsLowerFace) {
  testing::RandomGeometry random(41);
  for (int trial = 0; trial < 50; ++trial) {
    // Only turned about the vertical, whatever the link's own axes are.
    const Eigen::Matrix3d R_WL = random.Rotation().toRotationMatrix();
    const Eigen::Isometry3d X_WS = random.UprightPose(0.2);
    const Sole sole = SoleOf(
        With(Shape::Box({0.2, 0.1, 0.05}), Eigen::Isometry3d(R_WL.transpose()) * X_WS), R_WL, 1e-4);
    EXPECT_NEAR(sole.area, 0.02, 1e-9);
    ASSERT_EQ(sole.points.size(), 4u);
    for (const Vector3d& p : sole.points) {
      const Vector3d in_box = X_WS.inverse() * (R_WL * p);
      EXPECT_TRUE(in_box.cwiseAbs().isApprox(Vector3d(0.1, 0.05, 0.025), 1e-9));
      EXPECT_LT(in_box.z(), 0);
    }
  }
}

TEST(SoleTest, ATiltedBoxStandsOnAnEdgeUnlessTheSlackAllowsMore) {
  const Eigen::Matrix3d R = Eigen::AngleAxisd(0.01, Vector3d::UnitY()).toRotationMatrix();
  const Link link = With(Shape::Box({0.2, 0.1, 0.05}));
  EXPECT_EQ(SoleOf(link, R, 1e-4).area, 0);
  const Sole sole = SoleOf(link, R, 3e-3);
  EXPECT_NEAR(sole.area, 0.02 * std::cos(0.01), 1e-6);
  EXPECT_NEAR(sole.depth, 0.2 * std::sin(0.01), 1e-9);
  for (const Vector3d& p : sole.points) EXPECT_NEAR((R * p).z(), (R * sole.points[0]).z(), 1e-12);
}

TEST(SoleTest, SpheresBearAtTheirLowestPoints) {
  Link link;
  for (int i = 0; i < 4; ++i) {
    Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
    X.translation() = Vector3d(i & 1 ? 0.1 : -0.05, i & 2 ? 0.03 : -0.03, -0.04);
    link.shapes.push_back({Shape::Sphere(0.005), X});
  }
  const Sole sole = SoleOf(link, Eigen::Matrix3d::Identity(), 1e-4);
  EXPECT_NEAR(sole.area, 0.15 * 0.06, 1e-9);
  for (const Vector3d& p : sole.points) EXPECT_NEAR(p.z(), -0.045, 1e-12);
}

TEST(SoleTest, FewCornersStayInsideAndKeepMostOfTheArea) {
  std::vector<Vector3d> points;
  ConvexPolygon outline;
  constexpr int kCorners = 40;
  for (int i = 0; i < kCorners; ++i) {
    const double angle = 2 * std::numbers::pi * i / kCorners;
    outline.emplace_back(0.12 * std::cos(angle), 0.05 * std::sin(angle));
    points.emplace_back(outline.back().x(), outline.back().y(), -0.1);
    points.emplace_back(outline.back().x(), outline.back().y(), 0);
  }
  const Sole sole = SoleOf(With(Shape::ConvexMesh(points)), Eigen::Matrix3d::Identity(), 1e-4, 6);
  EXPECT_EQ(sole.points.size(), 6u);
  EXPECT_LT(sole.area, AreaOf(outline));
  // A regular hexagon has 3 sqrt(3) / (2 pi) of its circle's area; so has its stretched image.
  EXPECT_GT(sole.area, 0.75 * AreaOf(outline));
}

}  // namespace
}  // namespace possibility::models
