#pragma once

#include <optional>
#include <vector>

#include "actions/flood/route_flood.h"
#include "actions/plan/plan.h"

namespace possibility::actions {

/// Where a flood over C_S that has found a barrier would come through first if less were asked of
/// it: the narrowest place of the way that it finds with the least leniency. Nothing if it finds
/// none with gaits up to 0.6 m narrower and 0.3 m lower, and ground that reaches 0.3 m farther. An
/// aid for messages, of about so many floods' time as there are halvings of that leniency, each cut
/// short where it grows large.
std::optional<NarrowPassage> SearchPassage(const LocomotionModel& model, const World& world,
                                           const GroundedStance& start,
                                           const std::vector<GroundedStance>& goals,
                                           double resolution,
                                           const std::vector<FloodManoeuvre>& manoeuvres,
                                           const std::function<bool()>& keep_going);

}  // namespace possibility::actions
