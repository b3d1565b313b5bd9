#include "graph/straight_path.h"

#include <optional>
#include <utility>

namespace possibility::graph {
namespace {

/// The first action that C_S lets go along `edge`; nothing if none is sure or time is up.
std::optional<int> FirstSure(const PointPair& edge,
                             const std::vector<std::shared_ptr<const Action>>& actions,
                             const Deadline& deadline) {
  for (std::size_t action = 0; action < actions.size() && !deadline.Passed(); ++action) {
    if (actions[action]->CS(edge)) return static_cast<int>(action);
  }
  return std::nullopt;
}

}  // namespace

[[gnu::hot]] bool GoStraight(const Point& start, const std::vector<Point>& goals,
                             const std::vector<std::shared_ptr<const Action>>& actions,
                             const Deadline& deadline, PathResult* result) {
  for (std::size_t g = 0; g < goals.size(); ++g) {
    if (start == goals[g]) continue;
    PointPair edge{start, goals[g]};
    const std::optional<int> action = FirstSure(edge, actions, deadline);
    if (!action) continue;
    result->status = PathStatus::kFound;
    result->goal = static_cast<int>(g);
    result->counters.emplace("edges confirmed by C_S", 1);
    result->graph.vertices.reserve(2);
    result->graph.vertices.push_back(start);
    result->graph.vertices.push_back(goals[g]);
    result->graph.edges.push_back({0, 1, *action});
    result->path.push_back({*action, std::move(edge)});
    result->seconds = deadline.Elapsed();
    result->statistics.seconds = result->seconds;
    result->statistics.vertices = 2;
    result->statistics.edges = 1;
    return true;
  }
  return false;
}

}  // namespace possibility::graph
