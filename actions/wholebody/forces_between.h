#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "actions/plan/plan.h"
#include "actions/wholebody/motion_error.h"
#include "dynamics/tree/multibody_dynamics.h"
#include "models/robot/robot_model.h"

namespace possibility::actions {

/// Why the forces between two knots of a phase leave their friction cones, or the torques their
/// limits; none if they do not. The knots themselves are within both. Forces between them are those
/// of the file format (LeastForceChange), looked at in three places, unless they hardly stray from
/// the interpolated ones. `points`: those of Knot::forces; `t`: of `from` since the start of its
/// phase, s; `dynamics`: of the robot with a motor at every joint.
std::optional<MotionError> ForceFaultBetween(const models::RobotModel& robot,
                                             const std::vector<dynamics::ContactPoint>& points,
                                             const Knot& from, const Knot& to, double t,
                                             dynamics::MultibodyDynamics* dynamics);

}  // namespace possibility::actions
