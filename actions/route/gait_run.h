#pragma once

#include <optional>
#include <vector>

#include "actions/gait/gait_motion.h"
#include "actions/plan/plan.h"
#include "actions/route/route.h"
#include "common/cancellation_token.h"

namespace possibility::actions {

/// Longest expected duration of a run of several legs, s. A robot with feedback of its joints alone
/// strays a little at every touchdown, by up to 0.05 m in 100 s of walking with many turns.
inline constexpr double kLongestRun = 40;

/// Number of legs from `first` on that one motion may flow through: straight ways of one gait on
/// one height, of kLongestRun in all. At least 1.
int RunLength(const LocomotionModel& model, const Route& route, int first);

/// One motion through `count` legs of a run, cut where it passes their ends: the phases of every
/// leg, times from 0. The robot rests where the run begins and ends only. `end`: how it ends.
/// @throws MotionError if there is none; Cancelled.
std::vector<std::vector<Phase>> FlowAlong(const LocomotionModel& model, const Route& route,
                                          int first, int count, const FlowEnd& end,
                                          const CancellationToken& cancellation);

/// How a run that leads to a manoeuvre may end so that the first phase of the manoeuvre's motion
/// can be left out: that phase must turn joints of no limb of the gait, from rest to rest, and do
/// nothing else. None otherwise.
std::optional<FlowEnd> EndReadyFor(const NominalStance& stance,
                                   const std::vector<Phase>& manoeuvre);

}  // namespace possibility::actions
