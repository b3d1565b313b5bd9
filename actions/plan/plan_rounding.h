#pragma once

#include "actions/plan/plan.h"

namespace possibility::actions {

/// Rounds all numbers of the motion to the digits of a plan file, so that the plan reads back to
/// the same bits: what is verified is what is written.
/// @throws std::invalid_argument if a number is not finite.
void RoundToPlanDigits(Plan* plan);

}  // namespace possibility::actions
