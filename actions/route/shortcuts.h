#pragma once

#include <vector>

#include "actions/route/route_space.h"
#include "common/cancellation_token.h"
#include "graph/structure/path_edge.h"

namespace possibility::actions {

/// The quickest route through the places of a confirmed one, or to any of `goals`, within C_S
/// (ShortcutRoadmap); `route` itself if that is as quick. Long routes are searched piece by piece.
/// `route`: edges between nominal stances, end to end. Once cancelled, returns the best route so
/// far.
std::vector<graph::PathEdge> FindShortcuts(const RouteSpace& space,
                                           const std::vector<graph::PathEdge>& route,
                                           const std::vector<GroundedStance>& goals,
                                           const CancellationToken& cancellation);

}  // namespace possibility::actions
