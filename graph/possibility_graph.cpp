#include "graph/possibility_graph.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <stdexcept>
#include <utility>

namespace possibility::graph {

void NewElements::Append(const NewElements& other) {
  vertices.insert(vertices.end(), other.vertices.begin(), other.vertices.end());
  edges.insert(edges.end(), other.edges.begin(), other.edges.end());
}

PossibilityGraph::PossibilityGraph(const std::vector<std::shared_ptr<const Action>>& actions,
                                   const ExplorationSpace* space, const Point& start,
                                   const std::vector<Point>& goals)
    : actions_(actions), index_(space, start), num_changes_(actions.size(), 0) {
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

EdgeId PossibilityGraph::AddEdge(int action, VertexId from, VertexId to) {
  if (const auto existing = FindEdge(action, from, to)) {
    return *existing;
  }
  const double duration = actions_[action]->ExpectedDuration({points_[from], points_[to]});
  if (!std::isfinite(duration) || duration < 0) {
    throw std::invalid_argument("action " + actions_[action]->name() + ": ExpectedDuration is " +
                                std::to_string(duration) + ", expected a finite number >= 0");
  }
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
  using Visit = std::pair<double, VertexId>;
  std::vector<double> cost(points_.size(), std::numeric_limits<double>::infinity());
  std::vector<EdgeId> arrival(points_.size(), -1);
  std::vector<bool> settled(points_.size(), false);
  std::priority_queue<Visit, std::vector<Visit>, std::greater<>> open;
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

PointPair PossibilityGraph::points(EdgeId edge) const {
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
