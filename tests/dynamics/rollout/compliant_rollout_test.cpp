#include "dynamics/rollout/compliant_rollout.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/dynamics/random_robot.h"
#include "tests/dynamics/rollout/box.h"

namespace possibility::dynamics {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

/// On a slope of `degrees` that falls towards +x.
CompliantRollout BoxOnASlope(double degrees, double duration, double friction = 0.7) {
  const double slope = degrees * std::numbers::pi / 180;
  const Vector3d normal = SlopeNormal(slope);
  std::vector<RolloutContact> corners = Corners(normal);
  for (RolloutContact& corner : corners) corner.friction = friction;
  CompliantSimulator simulator(MultibodyModel::Spatial(Box()), corners, {});
  VectorXd q = BoxAt(0, 0, slope);
  q.tail<3>() = 0.1 * normal;
  return simulator.Run(q, VectorXd::Zero(6), 0, duration);
}

TEST(CompliantRollout, ABoxFallsFreelyAndComesToRestWhereItsWeightIsBorne) {
  CompliantSimulator simulator(MultibodyModel::Spatial(Box()), Corners(Vector3d::UnitZ()), {});
  const CompliantRollout rollout = simulator.Run(BoxAt(0.15), VectorXd::Zero(6), 0, 1);
  EXPECT_NEAR(rollout.Configuration(0.09)[6], 0.15 - 0.5 * kGravity * 0.09 * 0.09, 1e-6);
  const double depth = kGravity / (4 * CompliantGround().stiffness);
  EXPECT_NEAR(rollout.Configuration(1)[6], 0.1 - depth, 1e-7);
  EXPECT_LT(rollout.Velocity(1).norm(), 1e-4);
  const RobotMotion motion = simulator.MotionAt(rollout, 1);
  EXPECT_NEAR(motion.forces.row(2).sum(), kGravity, 0.02);
}

TEST(CompliantRollout, ABoxOnASlopeCreepsBelowTheAngleOfFriction) {
  // tan 30 degrees = 0.58 of a friction of 0.7.
  const CompliantRollout rollout = BoxOnASlope(30, 2);
  const double share = std::tan(std::numbers::pi / 6) / 0.7;
  const double creep = CompliantGround().slip_speed * share / std::sqrt(1 - share * share);
  EXPECT_NEAR(rollout.Velocity(2).tail<3>().norm(), creep, 0.05 * creep);
}

TEST(CompliantRollout, ABoxOnASlopeSlidesAboveTheAngleOfFriction) {
  const double slope = 40 * std::numbers::pi / 180;
  const CompliantRollout rollout = BoxOnASlope(40, 1);
  const double expected = kGravity * (std::sin(slope) - 0.7 * std::cos(slope));
  EXPECT_NEAR(rollout.Velocity(1).tail<3>().norm(), expected, 0.01 * expected);
}

/// It is twice as long as it is high, so it tips from atan 2 = 63 degrees on if it cannot slide.
TEST(CompliantRollout, ABoxThatCannotSlideTipsWhereItsWeightLeavesItsEdge) {
  constexpr double kRough = 4;
  EXPECT_LT(std::abs(BoxOnASlope(60, 0.3, kRough).Velocity(0.3)[1]), 0.01);
  EXPECT_GT(BoxOnASlope(67, 0.3, kRough).Velocity(0.3)[1], 0.1);
}

TEST(CompliantRollout, LandingLosesEnergy) {
  std::mt19937 random(5);
  const auto model = MultibodyModel::Spatial(Box());
  MultibodyDynamics dynamics(model);
  for (int trial = 0; trial < 5; ++trial) {
    CompliantSimulator simulator(model, Corners(Vector3d::UnitZ()), {});
    const VectorXd q = BoxAt(0.3, Uniform(&random, -0.4, 0.4), Uniform(&random, -0.4, 0.4));
    const CompliantRollout rollout = simulator.Run(q, RandomVector(&random, 6, 1), 0, 1.5);
    double before = 1e9;
    for (double t = 0; t <= 1.5; t += 0.05) {
      dynamics.SetState(rollout.Configuration(t), rollout.Velocity(t));
      const VectorXd v = rollout.Velocity(t);
      const double energy = 0.5 * v.dot(dynamics.MassMatrix() * v) +
                            kGravity * dynamics.kinematics().CentreOfMass().z();
      EXPECT_LT(energy, before + 1e-3) << t;  // J
      before = energy;
    }
  }
}

TEST(CompliantRollout, EndsWhereItIsToldTo) {
  CompliantRolloutSettings settings;
  settings.until = [](double, const auto& q) { return q[6] - 0.3; };
  CompliantSimulator simulator(MultibodyModel::Spatial(Box()), {}, {}, settings);
  const CompliantRollout rollout = simulator.Run(BoxAt(0.8), VectorXd::Zero(6), 0, 5);
  EXPECT_EQ(rollout.end, OdeEnd::kGuard);
  EXPECT_NEAR(rollout.trajectory.end_time(), std::sqrt(2 * 0.5 / kGravity), 1e-4);
}

TEST(CompliantRollout, AStateOfWrongSizeIsRefused) {
  CompliantSimulator simulator(MultibodyModel::Spatial(Box()), {}, {});
  EXPECT_THROW(simulator.Run(VectorXd::Zero(6), VectorXd::Zero(6), 0, 1), std::invalid_argument);
}

}  // namespace
}  // namespace possibility::dynamics
