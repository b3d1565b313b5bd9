#pragma once

#include "actions/gait/foothold_plan.h"

namespace possibility::actions {

/// How the body moves along with the steps of a pace. By default it does nothing of its own.
struct PaceStyle {
  double evenness = 1;  ///< of the speed of swings (EvenRestToRest)
  // With a full step:
  double turn = 0;       ///< rad: yaw of the root, with the side that has swung ahead
  double twist = 0;      ///< rad: of the trunk above the waist against the root, the other way
  double lean = 0;       ///< rad: pitch of the root beyond the stance's, forward
  double zmp_ahead = 0;  ///< m: of the balanced place of a swing's support
  /// The root is lowered where the limbs need it to reach their places.
  bool keeps_reach = false;

  bool operator==(const PaceStyle&) const = default;
};

/// Length and timing of a dynamic gait's steps, and how the body is carried.
struct Pace {
  StepBounds bounds;
  StepTiming timing;
  double rise = 0;  ///< m: height of the root above the stance's, once in motion
  PaceStyle style = {};
  int groups = 2;  ///< of limbs that swing in turn
  /// Between two steps over the bounds, every other group catches up once.
  double StepsEach() const { return groups - 1; }
  double speed() const {  ///< straight ahead, m/s
    return bounds.forward / (StepsEach() * (timing.swing + timing.double_support));
  }
};

}  // namespace possibility::actions
