#pragma once

#include "actions/verify/plan_margins.h"
#include "actions/verify/verdict_store.h"
#include "actions/verify/verifier_motion.h"

namespace possibility::actions {

/// MeasureMargins, except for phases whose margins the store has (null: none).
PlanMargins MarginsOf(const VerifiedPlan& subject, VerdictStore* store);

}  // namespace possibility::actions
