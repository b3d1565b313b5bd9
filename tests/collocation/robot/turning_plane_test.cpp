#include "collocation/robot/turning_plane.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "dynamics/tree/multibody_model.h"
#include "tests/collocation/robot/exact_derivatives.h"
#include "tests/dynamics/random_robot.h"

namespace possibility::collocation {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr int kPlace = 6;  // coordinates of a body without joints

/// Height of a point at `place` of a body without joints.
double HeightAt(const Vector3d& place, double turn, double offset) {
  std::mt19937 random(1);
  const RobotSystem body = dynamics::MultibodyModel::OnJoints(dynamics::RandomTree(&random, 0));
  const auto heights = HeightsOverTurningPlane(body, {{kPlace, Vector3d::Zero()}});
  VectorXd z = VectorXd::Zero(kPlace + 2);
  z.head<3>() = place;
  z[kPlace] = turn;
  z[kPlace + 1] = offset;
  VectorXd y(1);
  heights->Evaluate(z, &y);
  return y[0];
}

TEST(TurningPlaneTest, HeightsAreAlongTheNormal) {
  constexpr double kQuarter = std::numbers::pi / 2;
  const Vector3d place(0.3, 5, 0.2);
  EXPECT_NEAR(HeightAt(place, 0, 0.05), 0.15, 1e-12) << "level";
  EXPECT_NEAR(HeightAt(place, kQuarter, -0.4), 0.1, 1e-12) << "upright, before what is at x > 0.4";
  EXPECT_NEAR(HeightAt(place, -kQuarter, 0.1), 0.2, 1e-12) << "upright, behind what is at x < 0.1";
  EXPECT_NEAR(HeightAt(place, kQuarter / 2, 0), (0.2 - 0.3) / std::sqrt(2), 1e-12);
}

TEST(TurningPlaneTest, DerivativesAgreeWithDifferences) {
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 5; ++trial) {
    const RobotSystem robot = dynamics::MultibodyModel::OnJoints(dynamics::RandomTree(&random, 4));
    const auto heights = HeightsOverTurningPlane(
        robot, {{kPlace + 3, Vector3d(0.1, 0.2, -0.3)}, {kPlace + 1, Vector3d(0, 0.1, 0.2)}});
    VectorXd z(heights->num_inputs());
    for (double& x : z) x = 0.5 * normal(random);
    ExpectExactDerivatives(heights.get(), z, Eigen::Vector2d(0.7, -1.3));
  }
}

}  // namespace
}  // namespace possibility::collocation
