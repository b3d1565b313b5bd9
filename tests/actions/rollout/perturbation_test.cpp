#include "actions/rollout/perturbation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace possibility::actions {
namespace {

using Eigen::Vector3d;

TEST(PerturbationTest, TheForceOfAPushIntegratesToItsImpulse) {
  Perturbation perturbation;
  perturbation.push = 12;
  perturbation.push_direction = std::numbers::pi / 3;
  perturbation.push_share = 0.25;
  constexpr double kStep = 1e-4;  // s
  Vector3d impulse = Vector3d::Zero();
  double middle = 0;
  for (double t = 2; t < 6; t += kStep) {
    const Vector3d force = perturbation.PushAt(t, 2, 6);
    impulse += kStep * force;
    middle += kStep * t * force.norm();
  }
  EXPECT_LT((impulse - Vector3d(6, 6 * std::sqrt(3), 0)).norm(), 1e-5);
  EXPECT_NEAR(middle / 12, 3, 1e-5);
}

TEST(PerturbationTest, GroundRisesAlongTheAxisOfItsSlope) {
  Perturbation perturbation;
  EXPECT_EQ(perturbation.Tilt(), Eigen::Matrix3d::Identity());
  perturbation.slope = 0.1;
  EXPECT_NEAR((perturbation.Tilt() * Vector3d::UnitX()).z(), std::sin(0.1), 1e-12);
  EXPECT_NEAR((perturbation.Tilt() * Vector3d::UnitY()).z(), 0, 1e-12);
  perturbation = {};
  perturbation.side_slope = 0.1;
  EXPECT_NEAR((perturbation.Tilt() * Vector3d::UnitY()).z(), std::sin(0.1), 1e-12);
}

TEST(PerturbationTest, ScalesMassesInertiasAndLimits) {
  models::RobotModel robot;
  robot.links.resize(2);
  for (models::Link& link : robot.links) {
    link.inertial.mass = 4;
    link.inertial.I_LC = Eigen::Matrix3d::Identity();
  }
  robot.joints.resize(1);
  robot.joints[0].effort = 50;
  robot.joints[0].actuator.armature = 0.1;
  robot.joints[0].actuator.line = models::TorqueSpeedLine{80, 10};
  robot.gaits.resize(1);
  robot.gaits[0].limbs = {{0, true, {0}}};
  robot.friction = 0.7;
  Perturbation perturbation;
  perturbation.mass = 1.5;
  perturbation.torque = 0.5;
  perturbation.armature = 0.3;
  const models::RobotModel changed = perturbation.Perturbed(robot);
  EXPECT_DOUBLE_EQ(changed.TotalMass(), 12);
  EXPECT_DOUBLE_EQ(changed.links[1].inertial.I_LC(2, 2), 1.5);
  EXPECT_DOUBLE_EQ(changed.joints[0].effort, 25);
  EXPECT_DOUBLE_EQ(changed.joints[0].actuator.line->stall_torque, 40);
  EXPECT_DOUBLE_EQ(changed.joints[0].actuator.armature, 0.4);
  EXPECT_DOUBLE_EQ(changed.friction, 0.7);
  perturbation.friction = 0.2;
  EXPECT_DOUBLE_EQ(perturbation.Perturbed(robot).friction, 0.2);
}

}  // namespace
}  // namespace possibility::actions
