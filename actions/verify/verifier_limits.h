#pragma once

#include "actions/plan/interpolation.h"
#include "actions/verify/verifier_log.h"
#include "models/robot/robot_model.h"

namespace possibility::actions {

/// Root speeds beyond these (m/s, rad/s) are no robot's: they are refused with kJointSpeed, since
/// the work of looking between samples grows with speed.
inline constexpr double kLargestRootSpeed = 20;

/// Positions and speeds of all joints and the speed of the root against their limits, at all times
/// between the knots of `interpolant`, not only at samples: from the extrema of its polynomials.
/// Returns whether all speeds are within their limits. `segment` is to blame.
bool CheckJointLimits(const KnotInterpolant& interpolant, const models::RobotModel& robot,
                      int segment, ViolationLog* log);

/// Positions, speeds and accelerations of mimic joints against what follows from their masters,
/// likewise.
void CheckJointCouplings(const KnotInterpolant& interpolant, const models::RobotModel& robot,
                         int segment, ViolationLog* log);

/// `tau` (num_joints) against the effort limits; a master bears its mimics' torques as well.
void CheckTorqueLimits(const Eigen::VectorXd& tau, const models::RobotModel& robot,
                       const Instant& at, ViolationLog* log);

}  // namespace possibility::actions
