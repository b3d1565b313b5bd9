#pragma once

#include "actions/plan/plan.h"
#include "experiments/imports/imported_trajectory.h"
#include "models/robot/robot_model.h"
#include "models/world/scenario.h"

namespace possibility::experiments {

/// An imported motion as a plan for a scenario, with the digits of a plan file. If the file names
/// no actions, the motion is one segment of the scenario's start action. The goal is the one
/// nearest to the motion's end.
/// @throws InputError naming the file if there is no such action, or as CompleteMotion.
actions::Plan ImportPlan(const ImportedTrajectory& trajectory, const models::RobotModel& robot,
                         const models::Scenario& scenario);

}  // namespace possibility::experiments
