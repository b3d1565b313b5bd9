#pragma once

#include "actions/gait/foothold_plan.h"

namespace possibility::actions {

/// Length and timing of a dynamic gait's steps.
struct Pace {
  StepBounds bounds;
  StepTiming timing;
  double speed() const {  ///< straight ahead, m/s
    return bounds.forward / (timing.swing + timing.double_support);
  }
};

}  // namespace possibility::actions
