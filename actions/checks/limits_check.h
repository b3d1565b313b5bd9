#pragma once

#include "actions/evidence/violation_log.h"
#include "actions/plan/interpolation.h"
#include "models/robot/robot_model.h"

namespace possibility::actions {

/// Largest accepted root speed (m/s, rad/s), beyond that of any robot. Faster motion is refused
/// with kJointSpeed, because the work between samples grows with speed.
inline constexpr double kLargestRootSpeed = 20;

/// Checks positions and speeds of all joints and the speed of the root against their limits, at all
/// times between the knots of `interpolant`, from the extrema of its polynomials. Returns whether
/// all speeds are within their limits. `segment`: for the report.
bool CheckJointLimits(const KnotInterpolant& interpolant, const models::RobotModel& robot,
                      int segment, ViolationLog* log);

/// Checks positions, speeds and accelerations of mimic joints against those of their masters,
/// likewise.
void CheckJointCouplings(const KnotInterpolant& interpolant, const models::RobotModel& robot,
                         int segment, ViolationLog* log);

/// Checks `tau` (num_joints) against the effort limits and torque-speed lines at velocity `v` (nv);
/// a master also bears its mimics' torques.
void CheckTorqueLimits(const Eigen::VectorXd& tau, const Eigen::VectorXd& v,
                       const models::RobotModel& robot, const Instant& at, ViolationLog* log);

}  // namespace possibility::actions
