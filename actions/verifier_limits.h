#pragma once

#include "actions/verifier_log.h"
#include "models/robot_model.h"

namespace possibility::actions {

/// Root speeds beyond these (m/s, rad/s) are no robot's: they are refused with kJointSpeed, since
/// the work of looking between samples grows with speed.
inline constexpr double kLargestRootSpeed = 20;

/// Whether root and joints are as slow as they have to be.
bool IsWithinSpeedLimits(const Knot& knot, const models::RobotModel& robot);

/// Positions and speeds of all joints against their limits, and the speed of the root.
void CheckJointLimits(const Knot& knot, const models::RobotModel& robot, const Instant& at,
                      ViolationLog* log);

/// Positions, speeds and accelerations of mimic joints against what follows from their masters.
void CheckJointCouplings(const Knot& knot, const models::RobotModel& robot, const Instant& at,
                         ViolationLog* log);

/// `tau` (num_joints) against the effort limits; a master bears its mimics' torques as well.
void CheckTorqueLimits(const Eigen::VectorXd& tau, const models::RobotModel& robot,
                       const Instant& at, ViolationLog* log);

}  // namespace possibility::actions
