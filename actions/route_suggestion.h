#pragma once

#include <functional>
#include <span>
#include <vector>

#include "actions/route_search.h"

namespace possibility::actions {

/// The settings that SuggestRoute searches with, in their order: coarse lattices in a hurry first.
std::span<const RouteSearchSettings> SuggestionLadder();

/// A route by SearchRoute with the first settings of the ladder that find one; what all of them
/// miss is left to the random search, or proven not to be there. Arguments and answer as there.
std::vector<graph::PathEdge> SuggestRoute(const RouteSearchSpace& space,
                                          const GroundedStance& start,
                                          const std::vector<GroundedStance>& goals,
                                          const std::function<bool()>& keep_going);

}  // namespace possibility::actions
