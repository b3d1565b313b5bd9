#pragma once

#include "actions/plan/plan.h"
#include "models/robot/robot_model.h"
#include "models/world/scenario.h"

namespace possibility::actions {

/// The example of docs/collocation.md: a walk straight ahead as one optimal-control problem, from
/// the scenario's start to `distance` (m) ahead of it.
/// @throws MotionError if there is no such walk.
Plan OptimisedWalk(const models::RobotModel& robot, const models::Scenario& scenario,
                   double distance);

}  // namespace possibility::actions
