#pragma once

#include "actions/verify/verifier_log.h"
#include "actions/verify/verifier_state.h"

namespace possibility::actions {

/// Checks that robot and scenario are the plan's, and that the robot is the scenario's.
void CheckFiles(const Plan& plan, const models::RobotModel& robot, const models::Scenario& scenario,
                ViolationLog* log);

/// Checks that the plan has segments, phases and knots of the robot's sizes with finite numbers,
/// known contacts, and times without gaps. All other checks require this.
bool CheckStructure(const Plan& plan, const models::RobotModel& robot, ViolationLog* log);

/// Checks that q is continuous where phases and segments meet, and v where no impact lies between.
void CheckContinuity(const Plan& plan, const models::RobotModel& robot, ViolationLog* log);

}  // namespace possibility::actions
