#pragma once

#include <vector>

#include "actions/verify/verifier_contacts.h"
#include "actions/verify/verifier_log.h"
#include "actions/verify/verifier_state.h"

namespace possibility::actions {

/// Checks phases that begin with an impact: the declared impulses explain the jump of velocity, the
/// ground can give them, the points rest afterwards, and no energy is gained. `contacts`:
/// FollowContacts of the plan.
void CheckImpacts(const Plan& plan, const models::RobotModel& robot,
                  const std::vector<PhaseContacts>& contacts, StateEvaluator* evaluator,
                  ViolationLog* log);

}  // namespace possibility::actions
