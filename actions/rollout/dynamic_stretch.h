#pragma once

#include <vector>

#include "actions/plan/plan.h"
#include "actions/rollout/rollout_drift.h"

namespace possibility::actions {

/// Part of a plan that is simulated as one: from rest on the ground to rest on the ground, with
/// flight, impacts, or contacts that change while the robot moves. Independent of how its phases
/// are divided into segments.
struct DynamicStretch {
  int first_segment = 0;
  int last_segment = 0;
  Segment motion;  ///< all its phases
};

/// In the order of time. A stretch without rest before or after it extends to the plan's beginning
/// or end.
std::vector<DynamicStretch> DynamicStretches(const Plan& plan);

/// Result of simulating a dynamic stretch.
struct StretchRollout {
  int segment = 0;       ///< index of the first
  int last_segment = 0;  ///< index
  RolloutDrift drift;
};

}  // namespace possibility::actions
