#pragma once

#include <vector>

#include "collocation/transcription/trajectory.h"

namespace possibility::collocation {

/// A control that jumps, as far as a mesh can tell: it changes between two knots by a quarter of
/// its range or more, at ten times the rate that it has just before and just after.
struct ControlJump {
  int phase = 0;
  int control = 0;
  double share = 0;  ///< of the phase's duration: where a jump has the integral that was found
  double begin = 0;  ///< share of the knot before it
  double end = 0;    ///< share of the knot after it, at most three intervals later
  double before = 0, after = 0;  ///< the control at these knots
};

/// By phase, each in the order of controls and time. Jumps within the first or the last interval of
/// a phase are not seen.
std::vector<std::vector<ControlJump>> FindJumps(const Trajectory& trajectory);

}  // namespace possibility::collocation
