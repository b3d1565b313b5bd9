#pragma once

#include <vector>

#include "actions/flood/route_flood.h"

namespace possibility::actions {

/// Flood over C_N: cells of positions of the largest ball inside the pelvis that may be free and
/// within a limb's reach of ground, independent of orientation. `resolution` is refined until the
/// ball is larger than a cell. `flights`: of all manoeuvres.
FloodResult FloodNecessary(const LocomotionModel& model, const World& world,
                           const GroundedStance& start, const std::vector<GroundedStance>& goals,
                           double resolution, const FloodLimits& limits = {},
                           const std::vector<FlightBounds>& flights = {});

}  // namespace possibility::actions
