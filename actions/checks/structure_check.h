#pragma once

#include "actions/evidence/verifier_state.h"
#include "actions/evidence/violation_log.h"
#include "models/world/scenario.h"

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
