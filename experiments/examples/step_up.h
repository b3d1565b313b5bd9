#pragma once

#include "actions/conditions/manoeuvre.h"

namespace possibility::actions {

/// A step up onto higher ground, square to its edge, or backwards down from it; from walking stance
/// to walking stance. The example of docs/tutorial_new_action.md.
ManoeuvreFactory StepUpFactory();

}  // namespace possibility::actions
