#pragma once

#include <optional>
#include <vector>

#include "actions/gait/gait_motion.h"
#include "actions/gait/rounded_way.h"
#include "actions/plan/plan.h"
#include "actions/route/route.h"
#include "common/cancellation_token.h"

namespace possibility::actions {

/// Number of legs from `first` on that one motion may flow through: straight ways of one gait on
/// one height. At least 1.
int RunLength(const LocomotionModel& model, const Route& route, int first);

/// A place of a run, as if the run began at the origin: tolerances must not depend on the place.
/// Headings stay the route's.
PlanarPose SeenFrom(const PlanarPose& begin, const PlanarPose& pose);

/// The strides of `count` legs of a run, SeenFrom its beginning.
std::vector<StanceLine> StraightLinesOf(const LocomotionModel& model, const Route& route, int first,
                                        int count);

/// One motion along lines for `count` legs of a run, SeenFrom its beginning, cut where it passes
/// the legs' ends: the phases of every leg, times from 0. The robot rests where the run begins and
/// ends only. `end`: how it ends.
/// @throws MotionError if there is none; Cancelled.
std::vector<std::vector<Phase>> FlowAlong(const LocomotionModel& model, const Route& route,
                                          int first, int count,
                                          const std::vector<StanceLine>& lines, const FlowEnd& end,
                                          const CancellationToken& cancellation);

/// How a run that leads to a manoeuvre may end so that the first phase of the manoeuvre's motion
/// can be left out: that phase must turn joints of no limb of the gait, from rest to rest, and do
/// nothing else. None otherwise.
std::optional<FlowEnd> EndReadyFor(const NominalStance& stance,
                                   const std::vector<Phase>& manoeuvre);

}  // namespace possibility::actions
