#pragma once

#include "actions/plan/plan.h"

namespace possibility::actions {

/// Rounds all numbers of the motion to the digits of a plan file, so that the plan reads back to
/// the same bits: what is verified is what is written. Numbers that are not finite stay; the
/// verifier rejects them.
void RoundToPlanDigits(Plan* plan);

}  // namespace possibility::actions
