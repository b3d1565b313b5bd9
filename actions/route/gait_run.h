#pragma once

#include <vector>

#include "actions/plan/plan.h"
#include "actions/route/route.h"
#include "common/cancellation_token.h"

namespace possibility::actions {

/// Number of legs from `first` on that one motion may flow through: straight ways of one gait on
/// one height. At least 1.
int RunLength(const LocomotionModel& model, const Route& route, int first);

/// One motion through `count` legs of a run, cut where it passes their ends: the phases of every
/// leg, times from 0. The robot rests where the run begins and ends only.
/// @throws MotionError if there is none; Cancelled.
std::vector<std::vector<Phase>> FlowAlong(const LocomotionModel& model, const Route& route,
                                          int first, int count,
                                          const CancellationToken& cancellation);

}  // namespace possibility::actions
