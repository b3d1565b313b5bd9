#pragma once

#include "actions/plan/plan.h"
#include "models/robot/robot_model.h"
#include "models/world/scenario.h"

namespace possibility::actions {

/// How far (m) the scenario's first goal is ahead of its start.
/// @throws InputError unless both stand on their feet on one level, in one heading, and the goal is
///   straight ahead (to 1 cm and 0.01 rad) by 1 cm or more.
double DistanceAhead(const models::Scenario& scenario);

/// The example of docs/collocation.md: a walk straight ahead as one optimal-control problem, from
/// the scenario's start to `distance` (m) ahead of it.
/// @throws MotionError if there is no such walk.
Plan OptimisedWalk(const models::RobotModel& robot, const models::Scenario& scenario,
                   double distance);

}  // namespace possibility::actions
