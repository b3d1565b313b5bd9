#include "graph/search/straight_path.h"

#include <optional>
#include <utility>

namespace possibility::graph {
namespace {

/// The first action that C_S lets move along `edge`; nothing if there is none or time is up.
std::optional<int> FirstSure(const Edge& edge,
                             const std::vector<std::shared_ptr<const Action>>& actions,
                             const Deadline& deadline) {
  for (std::size_t action = 0; action < actions.size() && !deadline.Passed(); ++action) {
    if (actions[action]->CS(edge)) return static_cast<int>(action);
  }
  return std::nullopt;
}

void SetFound(const Deadline& deadline, PathResult* result) {
  const PathEdge& edge = result->path.front();
  result->status = PathStatus::kFound;
  result->found_by.emplace_back(kStraightExplorer);
  result->first_duration = result->duration;
  result->counters.emplace("edges confirmed by C_S", 1);
  result->graph.vertices.reserve(2);
  result->graph.vertices.push_back(edge.points.from);
  result->graph.vertices.push_back(edge.points.to);
  result->graph.edges.push_back({0, 1, edge.action});
  result->seconds = result->first_path_seconds = deadline.Elapsed();
  result->statistics.seconds = result->seconds;
  result->statistics.vertices = 2;
  result->statistics.edges = 1;
}

}  // namespace

bool GoStraight(const Point& start, const std::vector<Point>& goals,
                const std::vector<std::shared_ptr<const Action>>& actions, const Deadline& deadline,
                PathResult* result) {
  result->goal = -1;
  for (std::size_t g = 0; g < goals.size(); ++g) {
    if (start == goals[g]) return false;
    Edge edge{start, goals[g]};
    const std::optional<int> action = FirstSure(edge, actions, deadline);
    if (!action) continue;
    const double duration = actions[*action]->ExpectedDuration(edge);
    if (result->goal >= 0 && duration >= result->duration) continue;
    result->goal = static_cast<int>(g);
    result->duration = duration;
    result->path.clear();
    result->path.push_back({*action, std::move(edge), 0, 1});
  }
  if (result->goal < 0) return false;
  SetFound(deadline, result);
  return true;
}

}  // namespace possibility::graph
