#pragma once

#include "actions/conditions/manoeuvre.h"

namespace possibility::actions {

/// The name of the action in scenarios.
inline constexpr const char* kStepOver = "step_over";

/// A step over an obstacle that lies across the way, at most as high and thick as StepOverSettings
/// has it; forwards or backwards, in the first gait on two feet that is planned with.
/// The factory throws InputError if there is no such gait.
ManoeuvreFactory StepOverFactory();

}  // namespace possibility::actions
