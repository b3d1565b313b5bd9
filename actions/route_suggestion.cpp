#include "actions/route_suggestion.h"

namespace possibility::actions {

std::span<const RouteSearchSettings> SuggestionLadder() {
  static constexpr RouteSearchSettings kLadder[] = {
      {.step = 0.8, .headings = 1, .greed = 3, .most_stances = 20000},
      {.step = 0.8, .headings = 8, .greed = 4, .most_stances = 20000},
      {.step = 0.4, .headings = 8, .greed = 4, .most_stances = 20000},
      {.step = 0.2, .headings = 8, .greed = 4, .most_stances = 20000},
      {.step = 0.2, .headings = 16, .greed = 4, .most_stances = 20000}};
  return kLadder;
}

std::vector<graph::PathEdge> SuggestRoute(const RouteSearchSpace& space,
                                          const GroundedStance& start,
                                          const std::vector<GroundedStance>& goals,
                                          const std::function<bool()>& keep_going) {
  for (const RouteSearchSettings& settings : SuggestionLadder()) {
    std::vector<graph::PathEdge> route = SearchRoute(space, start, goals, settings, keep_going);
    if (!route.empty()) return route;
  }
  return {};
}

}  // namespace possibility::actions
