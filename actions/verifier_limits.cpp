#include "actions/verifier_limits.h"

#include <algorithm>
#include <cmath>

namespace possibility::actions {
namespace {

constexpr double kPositionTolerance = 1e-6;        // rad or m
constexpr double kSpeedTolerance = 1e-6;           // rad/s or m/s
constexpr double kRelativeTorqueTolerance = 1e-6;  // of the limit

// Rounding of positions grows with the square of the time between knots, 1 ms at the least.
constexpr double kAccelerationTolerance = 1e-3;  // rad/s^2 or m/s^2

struct Units {
  const char* position;
  const char* speed;
  const char* acceleration;
  const char* torque;
};

Units UnitsOf(const models::Joint& joint) {
  if (joint.type == models::JointType::kPrismatic) return {"m", "m/s", "m/s^2", "N"};
  return {"rad", "rad/s", "rad/s^2", "N m"};
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

void CheckJointCouplings(const Knot& knot, const models::RobotModel& robot, const Instant& at,
                         ViolationLog* log) {
  for (int j = 0; j < robot.num_joints(); ++j) {
    const models::Joint& joint = robot.joints[j];
    if (!joint.mimic) continue;
    const double multiplier = joint.mimic->multiplier;
    const double scale = std::max(1.0, std::abs(multiplier));
    const Units units = UnitsOf(joint);
    const auto require = [&](double value, double master, double tolerance, const char* unit,
                             const char* what) {
      log->RequireAtMost(ViolationKind::kJointCoupling, at, std::abs(value - multiplier * master),
                         0, scale * tolerance, unit, [&] {
                           return joint.name + what + " off that of " +
                                  robot.joints[joint.mimic->joint].name;
                         });
    };
    const int master = joint.mimic->joint;
    require(knot.q[7 + j] - joint.mimic->offset, knot.q[7 + master], kPositionTolerance,
            units.position, " position");
    require(knot.v[6 + j], knot.v[6 + master], kSpeedTolerance, units.speed, " speed");
    require(knot.a[6 + j], knot.a[6 + master], kAccelerationTolerance, units.acceleration,
            " acceleration");
  }
}

void CheckTorqueLimits(const Eigen::VectorXd& tau, const models::RobotModel& robot,
                       const Instant& at, ViolationLog* log) {
  Eigen::VectorXd borne = tau;
  for (int j = 0; j < robot.num_joints(); ++j) {
    const auto& mimic = robot.joints[j].mimic;
    if (mimic) borne[mimic->joint] += mimic->multiplier * tau[j];
  }
  for (int j = 0; j < robot.num_joints(); ++j) {
    const models::Joint& joint = robot.joints[j];
    if (joint.mimic) continue;
    const double tolerance = kRelativeTorqueTolerance * std::max(joint.effort, 1.0);
    log->RequireAtMost(ViolationKind::kJointTorque, at, std::abs(borne[j]), joint.effort, tolerance,
                       UnitsOf(joint).torque, [&] { return joint.name + " torque"; });
  }
}

}  // namespace possibility::actions
