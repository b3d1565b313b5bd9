#pragma once

#include "actions/evidence/violation_log.h"
#include "actions/verify/verifier.h"
#include "actions/verify/verifier_motion.h"

namespace possibility::actions {

/// Simulates the dynamic stretches, on settings.threads threads. Sets the rollouts and `cancelled`
/// of the report.
void VerifyRollouts(const VerifiedPlan& subject, const VerifierSettings& settings,
                    ViolationLog* log, VerificationReport* report);

/// What a simulation violates, the worst of each kind. The simulated stretch has no other
/// violation.
std::vector<Violation> RolloutViolations(const StretchRollout& rollout);

}  // namespace possibility::actions
