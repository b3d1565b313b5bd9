#pragma once

#include <optional>
#include <vector>

#include "actions/flood/route_flood.h"
#include "actions/plan/plan.h"
#include "common/cancellation_token.h"

namespace possibility::actions {

/// For a flood over C_S that found a barrier: the narrowest place of the way that it finds with the
/// least leniency. None if there is no way even with gaits 0.6 m narrower and 0.3 m lower and
/// ground that extends 0.3 m farther. For messages only. Takes about one flood per halving of the
/// leniency; large floods are cut short.
std::optional<NarrowPassage> SearchPassage(const LocomotionModel& model, const World& world,
                                           const GroundedStance& start,
                                           const std::vector<GroundedStance>& goals,
                                           double resolution,
                                           const std::vector<FloodManoeuvre>& manoeuvres,
                                           const CancellationToken& cancellation);

}  // namespace possibility::actions
