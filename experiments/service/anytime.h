#pragma once

#include "actions/planner/planner.h"
#include "experiments/report/plan_summary.h"
#include "models/robot/robot_model.h"
#include "models/world/scenario.h"

namespace possibility::experiments {

/// How near a plan is to the lower bound of its duration: the share of its duration that no other
/// plan can save, at most; 1 without a bound.
double GapOf(const actions::PlanResult& result);

/// Plans until the time limit (PlanRequest::improved). Writes the first plan and each that is
/// quicker as soon as it is verified, and prints a line for it; with `json` one object a line:
/// `plan --json` and `"anytime"`.
/// @throws InputError if something cannot be written.
actions::PlanResult PlanAnytime(const models::RobotModel& robot, const models::Scenario& scenario,
                                actions::PlanRequest request, const PlanFiles& files, bool json);

}  // namespace possibility::experiments
