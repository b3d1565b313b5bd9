#pragma once

#include <vector>

#include "actions/verify/verifier_contacts.h"
#include "actions/verify/verifier_log.h"
#include "actions/verify/verifier_state.h"

namespace possibility::actions {

/// Where phases begin with an impact: the jump of velocity is that of the declared impulses, these
/// are ones that the ground can give, the points rest afterwards, and no energy is won.
/// `contacts`: FollowContacts of the plan.
void CheckImpacts(const Plan& plan, const models::RobotModel& robot,
                  const std::vector<PhaseContacts>& contacts, StateEvaluator* evaluator,
                  ViolationLog* log);

}  // namespace possibility::actions
