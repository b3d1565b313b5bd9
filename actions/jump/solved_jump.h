#pragma once

#include <optional>
#include <vector>

#include "actions/jump/jump_motion.h"
#include "actions/jump/jump_problem.h"
#include "actions/plan/plan.h"

namespace possibility::actions {

/// A jump of the whole robot within all limits, independent of its place.
struct SolvedJump {
  JumpTask task;
  std::vector<Phase> phases;  ///< in the launch stance's frame, rest to rest, times from 0
  /// s, of a first phase that only turns joints; 0 if there is none. A gait that leads to the jump
  /// turns them, too.
  double preparation = 0;
  std::optional<JumpMotionReport> report = {};  ///< of its realisation; none if it was stored

  double duration() const { return phases.back().knots.back().t; }  ///< s
};

}  // namespace possibility::actions
