#pragma once

#include <vector>

#include "actions/flood/route_flood.h"

namespace possibility::actions {

/// Flood over C_S: cells of (gait, x, y, heading) in which C_S may hold somewhere, with shapes
/// shrunk by the size of a cell, connected by strides, transitions and manoeuvres. Without
/// manoeuvres it stays at the height of the start. More halvings or smaller cells take more time
/// and recognise more narrow passages as closed.
FloodResult FloodSufficient(const LocomotionModel& model, const World& world,
                            const GroundedStance& start, const std::vector<GroundedStance>& goals,
                            const StanceCellSettings& settings, const FloodLimits& limits = {},
                            const std::vector<FloodManoeuvre>& manoeuvres = {});

}  // namespace possibility::actions
