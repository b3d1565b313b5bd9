#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "actions/conditions/manoeuvre.h"
#include "actions/flood/route_flood.h"

namespace possibility::actions {

/// A start that nothing meeting C_S leads away from, or goals that nothing leads to: neither
/// strides of any class nor a transition has the room, and there is no manoeuvre. Floods, whose
/// cells err towards open, do not see that. Nothing if some way may begin at the start and end at a
/// goal, or the start is a goal.
std::optional<FloodResult> FindDeadEnd(const LocomotionModel& model, const World& world,
                                       const std::vector<std::shared_ptr<Manoeuvre>>& manoeuvres,
                                       const GroundedStance& start,
                                       const std::vector<GroundedStance>& goals);

}  // namespace possibility::actions
