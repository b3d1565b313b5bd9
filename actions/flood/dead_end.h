#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "actions/conditions/manoeuvre.h"
#include "actions/flood/route_flood.h"

namespace possibility::actions {

/// Detects a start that no motion within C_S leaves, or goals that no such motion reaches: no class
/// of strides and no transition has the room, and there is no manoeuvre. Floods miss this because
/// their cells are optimistic. None if some way may begin at the start and end at a goal, or if the
/// start is a goal.
std::optional<FloodResult> FindDeadEnd(const LocomotionModel& model, const World& world,
                                       const std::vector<std::shared_ptr<Manoeuvre>>& manoeuvres,
                                       const GroundedStance& start,
                                       const std::vector<GroundedStance>& goals);

}  // namespace possibility::actions
