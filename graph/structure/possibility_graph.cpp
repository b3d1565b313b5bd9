#include "graph/structure/possibility_graph.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <stdexcept>
#include <unordered_set>
#include <utility>

namespace possibility::graph {
namespace {

/// Vertices by the expected duration of the way to them, quickest first.
using Visit = std::pair<double, VertexId>;
using VisitQueue = std::priority_queue<Visit, std::vector<Visit>, std::greater<>>;

}  // namespace

void NewElements::Append(const NewElements& other) {
  vertices.insert(vertices.end(), other.vertices.begin(), other.vertices.end());
  edges.insert(edges.end(), other.edges.begin(), other.edges.end());
  offered.insert(offered.end(), other.offered.begin(), other.offered.end());
  line_ups.insert(line_ups.end(), other.line_ups.begin(), other.line_ups.end());
}

PossibilityGraph::PossibilityGraph(const std::vector<std::shared_ptr<const Action>>& actions,
                                   const ExplorationSpace* space, const Point& start,
                                   const std::vector<Point>& goals)
    : actions_(actions), space_(space), index_(space, start), num_changes_(actions.size(), 0) {
  start_ = VertexAt(start);
  downstream_from_start_.AddRoot(start_);
  for (const Point& goal : goals) {
    goals_.push_back(VertexAt(goal));
    upstream_from_goal_.AddRoot(goals_.back());
  }
}

VertexId PossibilityGraph::VertexAt(const Point& point) {
  if (const auto existing = FindVertexAt(point)) {
    return *existing;
  }
  const VertexId vertex = topology_.AddVertex();
  points_.push_back(point);
  index_.Insert(vertex, point);
  return vertex;
}

void PossibilityGraph::Append(int action, const std::vector<NewEdge>& edges) {
  for (const NewEdge& edge : edges) {
    const EdgeId there = AddEdge(action, edge.from, edge.to);
    if (edge.reversible) {
      const EdgeId back = AddEdge(action, edge.to, edge.from);
      edges_[there].opposite = back;
      edges_[back].opposite = there;
    }
  }
}

double PossibilityGraph::DurationBy(int action, const Edge& points) const {
  const double duration = actions_[action]->ExpectedDuration(points);
  if (!std::isfinite(duration) || duration < 0) {
    throw std::invalid_argument("action " + actions_[action]->name() + ": ExpectedDuration is " +
                                std::to_string(duration) + ", expected a finite number >= 0");
  }
  return duration;
}

void PossibilityGraph::RefreshDuration(EdgeId edge) {
  edges_[edge].duration = DurationBy(edges_[edge].confirmed_by, points(edge));
}

EdgeId PossibilityGraph::AddEdge(int action, VertexId from, VertexId to) {
  if (const auto existing = FindEdge(action, from, to)) {
    return *existing;
  }
  const double duration = DurationBy(action, {points_[from], points_[to]});
  const EdgeId edge = topology_.AddEdge(from, to);
  edges_.push_back({.action = action,
                    .duration = duration,
                    .opposite = std::nullopt,
                    .possibility = Possibility::kUnexamined,
                    .confirmed_by = action});
  downstream_from_start_.OnInserted(edge);
  upstream_from_goal_.OnInserted(edge);
  return edge;
}

std::optional<EdgeId> PossibilityGraph::FindEdge(int action, VertexId from, VertexId to) const {
  for (const EdgeId edge : topology_.outgoing(from)) {
    if (topology_.to(edge) == to && edges_[edge].action == action) {
      return edge;
    }
  }
  return std::nullopt;
}

void PossibilityGraph::Remove(EdgeId edge) {
  if (topology_.removed(edge)) {
    return;
  }
  topology_.Remove(edge);
  downstream_from_start_.OnRemoved(edge);
  upstream_from_goal_.OnRemoved(edge);
  ++num_changes_[edges_[edge].action];
}

void PossibilityGraph::Reinsert(EdgeId edge) {
  if (!topology_.removed(edge)) {
    return;
  }
  topology_.Reinsert(edge);
  downstream_from_start_.OnInserted(edge);
  upstream_from_goal_.OnInserted(edge);
  ++num_changes_[edges_[edge].action];
}

std::optional<std::vector<EdgeId>> PossibilityGraph::ShortestPath(VertexId from,
                                                                  VertexId to) const {
  std::vector<double> cost(points_.size(), std::numeric_limits<double>::infinity());
  std::vector<EdgeId> arrival(points_.size(), -1);
  std::vector<bool> settled(points_.size(), false);
  VisitQueue open;
  cost[from] = 0;
  open.emplace(0, from);
  while (!open.empty() && !settled[to]) {
    const VertexId vertex = open.top().second;
    open.pop();
    if (settled[vertex]) {
      continue;
    }
    settled[vertex] = true;
    for (const EdgeId edge : topology_.outgoing(vertex)) {
      const double through = cost[vertex] + edges_[edge].duration;
      const VertexId next = topology_.to(edge);
      if (!topology_.removed(edge) && through < cost[next]) {
        cost[next] = through;
        arrival[next] = edge;
        open.emplace(through, next);
      }
    }
  }
  if (!settled[to]) {
    return std::nullopt;
  }
  std::vector<EdgeId> path;
  for (VertexId vertex = to; vertex != from; vertex = topology_.from(path.back())) {
    path.push_back(arrival[vertex]);
  }
  std::reverse(path.begin(), path.end());
  return path;
}

std::vector<double> PossibilityGraph::LeastDurations(const std::vector<VertexId>& roots,
                                                     Reachability::Direction direction,
                                                     const EdgeFilter& include) const {
  const bool downstream = direction == Reachability::Direction::kDownstream;
  std::vector<double> least(points_.size(), std::numeric_limits<double>::infinity());
  VisitQueue open;
  for (const VertexId root : roots) {
    least[root] = 0;
    open.emplace(0, root);
  }
  while (!open.empty()) {
    const auto [duration, vertex] = open.top();
    open.pop();
    if (duration > least[vertex]) {
      continue;
    }
    for (const EdgeId edge : downstream ? topology_.outgoing(vertex) : topology_.incoming(vertex)) {
      const VertexId next = downstream ? topology_.to(edge) : topology_.from(edge);
      const double through = duration + edges_[edge].duration;
      if (through < least[next] && include(edge)) {
        least[next] = through;
        open.emplace(through, next);
      }
    }
  }
  return least;
}

bool PossibilityGraph::LeadsWithin(VertexId from, VertexId to, double limit,
                                   const EdgeFilter& include) const {
  std::unordered_set<VertexId> settled;
  VisitQueue open;
  open.emplace(0, from);
  while (!open.empty()) {
    const auto [duration, vertex] = open.top();
    open.pop();
    if (vertex == to) {
      return true;
    }
    if (!settled.insert(vertex).second) {
      continue;
    }
    for (const EdgeId edge : topology_.outgoing(vertex)) {
      const double through = duration + edges_[edge].duration;
      if (through <= limit && include(edge)) {
        open.emplace(through, topology_.to(edge));
      }
    }
  }
  return false;
}

Edge PossibilityGraph::points(EdgeId edge) const {
  return {points_[topology_.from(edge)], points_[topology_.to(edge)]};
}

void PossibilityGraph::SetPossibility(EdgeId edge, Possibility possibility) {
  edges_[edge].possibility = possibility;
}

void PossibilityGraph::SetPossible(EdgeId edge, int confirmed_by) {
  edges_[edge].possibility = Possibility::kPossible;
  edges_[edge].confirmed_by = confirmed_by;
}

}  // namespace possibility::graph
