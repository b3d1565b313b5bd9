#pragma once

#include "actions/gait/foothold_plan.h"

namespace possibility::actions {

/// Length and timing of a dynamic gait's steps, and how high the root is carried.
struct Pace {
  StepBounds bounds;
  StepTiming timing;
  double rise = 0;        ///< m: height of the root above the stance's, once in motion
  double speed() const {  ///< straight ahead, m/s
    return bounds.forward / (timing.swing + timing.double_support);
  }
};

}  // namespace possibility::actions
