#pragma once

#include <optional>
#include <vector>

#include "actions/flood/pelvis_cells.h"
#include "actions/flood/route_flood.h"

namespace possibility::actions {

/// The cells that FloodNecessary floods. `flights`: of all manoeuvres. The arguments must outlive
/// them.
PelvisCells PelvisCellsOf(const LocomotionModel& model, const World& world, double resolution,
                          const std::vector<FlightBounds>& flights);

/// All open blocks that FloodNecessary reaches from the start, disjoint; none if cut short.
std::optional<std::vector<CellBlock>> ReachedCells(const PelvisCells& cells,
                                                   const GroundedStance& start,
                                                   const FloodLimits& limits);

/// Flood over C_N: cells of positions of the largest ball inside the pelvis that may be free and
/// within a limb's reach of ground, independent of orientation. `resolution` is refined until the
/// ball is larger than a cell. `flights`: of all manoeuvres.
FloodResult FloodNecessary(const LocomotionModel& model, const World& world,
                           const GroundedStance& start, const std::vector<GroundedStance>& goals,
                           double resolution, const FloodLimits& limits = {},
                           const std::vector<FlightBounds>& flights = {});

}  // namespace possibility::actions
