#pragma once

#include "actions/plan/plan.h"
#include "actions/verify/verifier_log.h"
#include "models/robot/robot_model.h"
#include "models/world/scenario.h"

namespace possibility::actions {

/// How far beyond the scenario's bounds, which hold for stances, the root may sway between two
/// stances, m.
inline constexpr double kSway = 0.15;

/// Whether the plan does nothing but what the scenario allows: its actions are among the
/// scenario's, each begins in the gait in which the one before ends, and what a segment does is
/// that action: a gait bears on its own limbs' patches and neither flies nor lands, nor does a
/// transition. What a manoeuvre that the robot's file does not know may do, nobody can say. A
/// scenario without any actions (none that was read from a file) allows all.
void CheckActions(const Plan& plan, const models::RobotModel& robot,
                  const models::Scenario& scenario, ViolationLog* log);

/// Whether the root keeps within the scenario's bounds and kSway, proven for all instants. Bounds
/// that are empty bound nothing.
void CheckBounds(const Plan& plan, const models::Scenario& scenario, ViolationLog* log);

}  // namespace possibility::actions
