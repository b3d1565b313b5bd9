#include "actions/verifier_limits.h"

#include <algorithm>
#include <cmath>

namespace possibility::actions {
namespace {

constexpr double kPositionTolerance = 1e-6;        // rad or m
constexpr double kSpeedTolerance = 1e-6;           // rad/s or m/s
constexpr double kRelativeTorqueTolerance = 1e-6;  // of the limit

struct Units {
  const char* position;
  const char* speed;
  const char* torque;
};

Units UnitsOf(const models::Joint& joint) {
  if (joint.type == models::JointType::kPrismatic) return {"m", "m/s", "N"};
  return {"rad", "rad/s", "N m"};
}

void CheckSpeeds(const Knot& knot, const models::RobotModel& robot, const Instant& at,
                 ViolationLog* log) {
  log->RequireAtMost(ViolationKind::kJointSpeed, at, knot.v.head<3>().norm(), kLargestRootSpeed,
                     kSpeedTolerance, "rad/s", [] { return std::string("root angular speed"); });
  log->RequireAtMost(ViolationKind::kJointSpeed, at, knot.v.segment<3>(3).norm(), kLargestRootSpeed,
                     kSpeedTolerance, "m/s", [] { return std::string("root speed"); });
  for (int j = 0; j < robot.num_joints(); ++j) {
    const models::Joint& joint = robot.joints[j];
    log->RequireAtMost(ViolationKind::kJointSpeed, at, std::abs(knot.v[6 + j]), joint.velocity,
                       kSpeedTolerance, UnitsOf(joint).speed,
                       [&] { return joint.name + " speed"; });
  }
}

}  // namespace

bool IsWithinSpeedLimits(const Knot& knot, const models::RobotModel& robot) {
  ViolationLog log;
  CheckSpeeds(knot, robot, {}, &log);
  return !log.Has(ViolationKind::kJointSpeed);
}

void CheckJointLimits(const Knot& knot, const models::RobotModel& robot, const Instant& at,
                      ViolationLog* log) {
  for (int j = 0; j < robot.num_joints(); ++j) {
    const models::Joint& joint = robot.joints[j];
    const char* unit = UnitsOf(joint).position;
    const double q = knot.q[7 + j];
    log->RequireAtMost(ViolationKind::kJointPosition, at, q, joint.upper, kPositionTolerance, unit,
                       [&] { return joint.name + " above its upper limit"; });
    log->RequireAtLeast(ViolationKind::kJointPosition, at, q, joint.lower, kPositionTolerance, unit,
                        [&] { return joint.name + " below its lower limit"; });
  }
  CheckSpeeds(knot, robot, at, log);
}

void CheckTorqueLimits(const Eigen::VectorXd& tau, const models::RobotModel& robot,
                       const Instant& at, ViolationLog* log) {
  for (int j = 0; j < robot.num_joints(); ++j) {
    const models::Joint& joint = robot.joints[j];
    const double tolerance = kRelativeTorqueTolerance * std::max(joint.effort, 1.0);
    log->RequireAtMost(ViolationKind::kJointTorque, at, std::abs(tau[j]), joint.effort, tolerance,
                       UnitsOf(joint).torque, [&] { return joint.name + " torque"; });
  }
}

}  // namespace possibility::actions
