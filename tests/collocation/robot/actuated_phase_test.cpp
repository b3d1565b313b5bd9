// Least time of a motor with a rotor, friction and a torque-speed line, against its closed form.

#include <gtest/gtest.h>

#include <cmath>

#include "collocation/robot/robot_phase.h"
#include "collocation/study/optimal_control.h"
#include "dynamics/tree/multibody_model.h"

namespace possibility::collocation {
namespace {

constexpr double kEffort = 10;      // N m
constexpr double kVelocity = 12;    // rad/s, at the end
constexpr double kArmature = 0.05;  // kg m^2
constexpr double kViscous = 0.1;    // N m s/rad
constexpr models::TorqueSpeedLine kLine{15, 20};

/// Two links that turn against each other about their common centre of mass, falling freely.
models::RobotModel TwoWheels() {
  models::RobotModel robot;
  robot.links.resize(2);
  robot.links[0].inertial = {5, Eigen::Vector3d::Zero(), 0.5 * Eigen::Matrix3d::Identity()};
  robot.links[1].inertial = {2, Eigen::Vector3d::Zero(), 0.1 * Eigen::Matrix3d::Identity()};
  models::Joint joint;
  joint.name = "wheel";
  joint.axis = Eigen::Vector3d::UnitY();
  joint.lower = -3;
  joint.upper = 3;
  joint.velocity = 18;
  joint.effort = kEffort;
  joint.actuator = {kArmature, kViscous, 0, 0.1, kLine};
  robot.joints.push_back(joint);
  return robot;
}

/// First at the effort limit, then on the line: I dv/dt = e - b v, I dv/dt = s - (s / w + b) v.
double LeastTime() {
  const double inertia = 0.5 * 0.1 / (0.5 + 0.1) + kArmature;
  const double corner = kLine.no_load_speed * (1 - kEffort / kLine.stall_torque);
  const double slope = kLine.stall_torque / kLine.no_load_speed + kViscous;
  return -inertia / kViscous * std::log(1 - kViscous * corner / kEffort) +
         inertia / slope *
             std::log((kLine.stall_torque - slope * corner) /
                      (kLine.stall_torque - slope * kVelocity));
}

TEST(ActuatedPhase, SpinsUpInTheLeastTimeThatItsMotorAllows) {
  const auto model = dynamics::MultibodyModel::Planar(TwoWheels());
  for (const Torques torques : {Torques::kRows, Torques::kControls}) {
    OptimalControlProblem problem("spin");
    const RobotPhase robot = AddRobotPhase(&problem, "spin", model, {}, {}, torques);
    for (const Variable q : robot.q) robot.phase->Fix(q, 0, At::kStart);
    for (const Variable v : robot.v) robot.phase->Fix(v, 0, At::kStart);
    robot.phase->Fix(robot.v.back(), kVelocity, At::kEnd);
    robot.phase->SetDuration({0.05, 1});
    problem.AddCost({robot.phase->duration(), At::kEnd});
    OptimalControlOptions options;
    options.intervals = {40};
    options.check_derivatives = true;
    const OptimalControlResult result = SolveOptimalControl(problem, options);
    ASSERT_TRUE(result.succeeded()) << result.message;
    EXPECT_NEAR(result.objective, LeastTime(), 1e-3 * LeastTime());
  }
}

}  // namespace
}  // namespace possibility::collocation
