#pragma once

#include <vector>

#include "actions/checks/contacts_check.h"
#include "actions/evidence/verifier_state.h"
#include "actions/evidence/violation_log.h"

namespace possibility::actions {

/// Checks phases that begin with an impact: the declared impulses explain the jump of velocity, the
/// ground can give them, the points rest afterwards, and no energy is gained. `contacts`:
/// FollowContacts of the plan.
void CheckImpacts(const Plan& plan, const models::RobotModel& robot,
                  const std::vector<PhaseContacts>& contacts, StateEvaluator* evaluator,
                  ViolationLog* log);

}  // namespace possibility::actions
