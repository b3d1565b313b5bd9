#pragma once

#include "actions/checks/structure_check.h"
#include "models/world/scenario.h"

namespace possibility::actions {

/// Checks that the plan begins at the scenario's start and ends at its goal, at rest.
void CheckEnds(const Plan& plan, const models::RobotModel& robot, const models::Scenario& scenario,
               StateEvaluator* evaluator, ViolationLog* log);

}  // namespace possibility::actions
