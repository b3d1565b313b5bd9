#pragma once

#include <functional>
#include <vector>

#include "actions/route/route_space.h"
#include "graph/path_edge.h"

namespace possibility::actions {

/// The quickest route through the places of a confirmed one, or to any of `goals`, within C_S
/// (ShortcutRoadmap); `route` itself if that is as quick. Long routes are searched piece by piece.
/// `route`: edges between nominal stances, end to end. `keep_going`: called regularly, may be
/// empty; false returns the best route so far.
std::vector<graph::PathEdge> FindShortcuts(const RouteSpace& space,
                                           const std::vector<graph::PathEdge>& route,
                                           const std::vector<GroundedStance>& goals,
                                           const std::function<bool()>& keep_going);

}  // namespace possibility::actions
