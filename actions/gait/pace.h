#pragma once

#include "actions/gait/foothold_plan.h"

namespace possibility::actions {

/// Length and timing of a dynamic gait's steps, and how high the root is carried.
struct Pace {
  StepBounds bounds;
  StepTiming timing;
  double rise = 0;  ///< m: height of the root above the stance's, once in motion
  int groups = 2;   ///< of limbs that swing in turn
  /// Between two steps over the bounds, every other group catches up once.
  double StepsEach() const { return groups - 1; }
  double speed() const {  ///< straight ahead, m/s
    return bounds.forward / (StepsEach() * (timing.swing + timing.double_support));
  }
};

}  // namespace possibility::actions
