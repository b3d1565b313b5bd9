#pragma once

#include "actions/verify/verifier_log.h"
#include "actions/verify/verifier_state.h"

namespace possibility::actions {

/// Whether robot and scenario are those the plan was made for, and the robot is the scenario's.
void CheckFiles(const Plan& plan, const models::RobotModel& robot, const models::Scenario& scenario,
                ViolationLog* log);

/// Whether the plan has segments, phases and knots of the robot's sizes with finite numbers, known
/// contacts, and time that runs without gaps. Everything else may only be looked at if so.
bool CheckStructure(const Plan& plan, const models::RobotModel& robot, ViolationLog* log);

/// Whether q is continuous where phases and segments meet, and v where no impact lies between.
void CheckContinuity(const Plan& plan, const models::RobotModel& robot, ViolationLog* log);

}  // namespace possibility::actions
