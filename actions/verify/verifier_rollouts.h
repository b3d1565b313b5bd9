#pragma once

#include <vector>

#include "actions/verify/verifier.h"
#include "actions/verify/verifier_log.h"
#include "actions/verify/verifier_motion.h"

namespace possibility::actions {

/// Part of a plan that is simulated as one: from rest on the ground to rest on the ground, with
/// flight or impacts between. Independent of how its phases are divided into segments.
struct DynamicStretch {
  int first_segment = 0;
  int last_segment = 0;
  Segment motion;  ///< all its phases
};

/// In the order of time. A stretch without rest before or after it extends to the plan's beginning
/// or end.
std::vector<DynamicStretch> DynamicStretches(const Plan& plan);

/// Simulates the dynamic stretches, on settings.threads threads. Sets the rollouts and `cancelled`
/// of the report.
void VerifyRollouts(const VerifiedPlan& subject, const VerifierSettings& settings,
                    ViolationLog* log, VerificationReport* report);

}  // namespace possibility::actions
