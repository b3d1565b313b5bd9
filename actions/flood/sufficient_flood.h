#pragma once

#include <vector>

#include "actions/flood/route_flood.h"

namespace possibility::actions {

/// Flood over what can be confirmed: cells of (gait, x, y, heading) in which C_S may hold
/// somewhere, with shapes shrunk by the size of a cell, joined through transitions and manoeuvres.
/// Without manoeuvres nobody leaves the height of the start. More halvings or smaller cells take
/// more time, and narrower passages for closed.
FloodResult FloodSufficient(const LocomotionModel& model, const World& world,
                            const GroundedStance& start, const std::vector<GroundedStance>& goals,
                            const StanceCellSettings& settings, const FloodLimits& limits = {},
                            const std::vector<FloodManoeuvre>& manoeuvres = {});

}  // namespace possibility::actions
