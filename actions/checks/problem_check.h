#pragma once

#include "actions/evidence/violation_log.h"
#include "actions/plan/plan.h"
#include "models/robot/robot_model.h"
#include "models/world/scenario.h"

namespace possibility::actions {

/// Largest sway of the root beyond the scenario's bounds between two stances, m. The bounds hold
/// for stances.
inline constexpr double kSway = 0.15;

/// Checks that the plan does only what the scenario allows: its actions are among the scenario's,
/// each begins in the gait in which the previous one ends, and each segment fits its action. A gait
/// bears only on its own limbs' patches; gaits and transitions neither fly nor land. Manoeuvres
/// that the robot's file does not list are unrestricted. A scenario without actions (never one read
/// from a file) allows all.
void CheckActions(const Plan& plan, const models::RobotModel& robot,
                  const models::Scenario& scenario, ViolationLog* log);

/// Checks that the root stays within the scenario's bounds plus kSway, proven for all instants.
/// Empty bounds bound nothing.
void CheckBounds(const Plan& plan, const models::Scenario& scenario, ViolationLog* log);

}  // namespace possibility::actions
