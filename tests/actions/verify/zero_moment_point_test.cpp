#include "actions/verify/zero_moment_point.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "actions/wholebody/support_polygon.h"

namespace possibility::actions {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector2d;
using Eigen::Vector3d;

/// Forces that push up and pull in any other direction.
Matrix3Xd RandomForces(int count) {
  Matrix3Xd forces = 100 * Matrix3Xd::Random(3, count);
  forces.row(2) = forces.row(2).cwiseAbs().array() + 1;
  return forces;
}

TEST(ZeroMomentPoint, OfForcesIsWhereTheirHorizontalMomentVanishes) {
  std::srand(1);
  for (int trial = 0; trial < 100; ++trial) {
    const int count = 1 + trial % 8;
    const Matrix3Xd points = Matrix3Xd::Random(3, count);
    const Matrix3Xd forces = RandomForces(count);
    const Vector3d zmp = ZeroMomentPoint(points, forces, 0).value();
    Vector3d moment = Vector3d::Zero();
    for (int i = 0; i < count; ++i) {
      moment += Vector3d(points.col(i) - zmp).cross(Vector3d(forces.col(i)));
    }
    EXPECT_LT(moment.head<2>().norm(), 1e-10);
  }
}

TEST(ZeroMomentPoint, OfLevelPointsIsTheMeanWeightedByNormalForce) {
  std::srand(2);
  for (int trial = 0; trial < 100; ++trial) {
    Matrix3Xd points = Matrix3Xd::Random(3, 5);
    points.row(2).setConstant(0.25);
    const Matrix3Xd forces = RandomForces(5);
    Vector3d mean = Vector3d::Zero();
    for (int i = 0; i < 5; ++i) mean += forces(2, i) / forces.row(2).sum() * points.col(i);
    EXPECT_LT((ZeroMomentPoint(points, forces, 0).value() - mean).norm(), 1e-12);
  }
}

TEST(ZeroMomentPoint, OfALightLoadIsNone) {
  EXPECT_FALSE(ZeroMomentPoint(Matrix3Xd(3, 0), Matrix3Xd(3, 0), 0).has_value());
  Matrix3Xd forces = Matrix3Xd::Zero(3, 2);
  EXPECT_FALSE(ZeroMomentPoint(Matrix3Xd::Random(3, 2), forces, 0).has_value());
  forces(2, 0) = 5;
  EXPECT_FALSE(ZeroMomentPoint(Matrix3Xd::Random(3, 2), forces, 5).has_value());
  EXPECT_TRUE(ZeroMomentPoint(Matrix3Xd::Random(3, 2), forces, 4.9).has_value());
}

TEST(SupportMargin, OfARectangleIsTheDistanceFromItsSides) {
  Matrix3Xd points(3, 5);
  points << -1, 1, 1, -1, 0,  //
      -2, -2, 2, 2, 0.5,      //
      0.3, 0.3, 0.3, 0.3, 0.3;
  EXPECT_NEAR(SupportMargin(points, {0, 0}), 1, 1e-12);
  EXPECT_NEAR(SupportMargin(points, {0.1, 1.8}), 0.2, 1e-12);
  EXPECT_NEAR(SupportMargin(points, {1.5, 0}), -0.5, 1e-12);
}

TEST(SupportMargin, AgreesWithTheSupportPolygon) {
  std::srand(3);
  for (int trial = 0; trial < 200; ++trial) {
    Matrix3Xd points = Matrix3Xd::Random(3, 3 + trial % 6);
    points.row(2).setZero();
    std::vector<Vector2d> seen;
    for (const auto& point : points.colwise()) seen.emplace_back(point.head<2>());
    const Vector2d inside = points.rowwise().mean().head<2>() + 0.1 * Vector2d::Random();
    EXPECT_NEAR(SupportMargin(points, inside), SupportPolygon(seen).Margin(inside), 1e-9);
  }
}

TEST(SupportMargin, OfWhatIsNoPolygonIsNotANumber) {
  EXPECT_TRUE(std::isnan(SupportMargin(Matrix3Xd(3, 0), {0, 0})));
  Matrix3Xd line(3, 3);
  line << 0, 1, 2,  //
      0, 1, 2,      //
      0, 0, 0;
  EXPECT_TRUE(std::isnan(SupportMargin(line, {1, 1})));
  Matrix3Xd step(3, 3);
  step << 0, 1, 0,  //
      0, 0, 1,      //
      0, 0, 0.1;
  EXPECT_TRUE(std::isnan(SupportMargin(step, {0.2, 0.2})));
}

}  // namespace
}  // namespace possibility::actions
