#pragma once

#include <optional>
#include <vector>

#include "actions/conditions/locomotion_model.h"
#include "actions/conditions/manoeuvre_bounds.h"
#include "actions/conditions/quasi_static_action.h"
#include "common/cancellation_token.h"

namespace possibility::actions {

/// Lower bound on the length of a way of the pelvis from the start to the nearest goal, seen from
/// above, m. The way leads through cells that the flood over C_N reaches from the start, at any
/// height, or beside such a cell: motions sway. Never less than the straight distance. None if no
/// way leads there, there are too many cells, or time runs out.
///
/// The region is a union of cells, so its shortest ways bend at corners of cells. Steps along edges
/// and diagonals of the cells that a straight line crosses follow it from corner to corner, and are
/// longer by a factor of at most 1 / cos(22.5 degrees) where cells are square: dividing by that
/// bounds the length of any way.
/// `flights`: of all manoeuvres. `resolution`: of cells, m.
std::optional<double> LeastWay(const LocomotionModel& model, const World& world,
                               const GroundedStance& start,
                               const std::vector<GroundedStance>& goals, double resolution,
                               const std::vector<FlightBounds>& flights,
                               const CancellationToken& cancellation = {});

}  // namespace possibility::actions
