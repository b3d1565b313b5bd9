#pragma once

#include "actions/plan/plan.h"
#include "models/robot/robot_model.h"

namespace possibility::actions {

/// A plan of either version as one of version 2 (docs/file_formats.md), whose motion obeys the
/// equation of motion between its knots too. Phases whose contacts cannot supply every wrench
/// (flight, points on one line) are moved so that they need none that they have not, by as much as
/// they strayed (about 1e-6 m); the phases after them lead back. The motion is rounded to the steps
/// of a packed file; forces are those that the verifier computes from the plan's, and tau follows
/// from both, as CompleteTorques computes it. A plan of version 2 is returned as it is.
/// @throws InputError if a phase does not fit the robot; std::invalid_argument if a number is not
///   finite or too large, or a phase has less than two knots.
Plan RefinedPlan(const Plan& plan, const models::RobotModel& robot);

}  // namespace possibility::actions
