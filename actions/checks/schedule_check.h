#pragma once

#include "actions/evidence/verifier_state.h"
#include "actions/evidence/violation_log.h"

namespace possibility::actions {

/// Checks that the motion follows the plan's contact schedule, if it has one: when which contacts
/// bear, and where.
void CheckSchedule(const Plan& plan, const models::RobotModel& robot, StateEvaluator* evaluator,
                   ViolationLog* log);

}  // namespace possibility::actions
