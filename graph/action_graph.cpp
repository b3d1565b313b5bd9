#include "graph/action_graph.h"

#include <utility>

namespace possibility::graph {

void SubGraph::AddVertex(VertexId vertex, const Point& point) {
  vertices_.push_back(vertex);
  points_.push_back(point);
}

void SubGraph::Append(const SubGraph& other) {
  vertices_.insert(vertices_.end(), other.vertices_.begin(), other.vertices_.end());
  points_.insert(points_.end(), other.points_.begin(), other.points_.end());
}

SubGraph::Closest SubGraph::FindClosestVertexTo(const Point& p,
                                                const ExplorationSpace& space) const {
  std::size_t closest = 0;
  double least = space.Distance(points_[0], p);
  for (std::size_t i = 1; i < points_.size(); ++i) {
    const double distance = space.Distance(points_[i], p);
    if (distance < least) {
      least = distance;
      closest = i;
    }
  }
  return {vertices_[closest], least};
}

void ActionGraph::Append(const NewElements& elements) {
  for (const VertexId vertex : elements.vertices) {
    AddVertex(vertex);
  }
  for (const NewEdge& edge : elements.edges) {
    edges_.push_back(edge);
    const bool found_before = master_->FindEdge(action_, edge.from, edge.to).has_value();
    if (!found_before || !Severed(edge)) {
      Join(edge.from, edge.to);
    }
  }
}

const std::vector<SubGraph>& ActionGraph::SubGraphs() {
  if (changes_seen_ != master_->num_changes(action_)) {
    Rebuild();
    changes_seen_ = master_->num_changes(action_);
  }
  return subgraphs_;
}

std::optional<int> ActionGraph::SubGraphOf(VertexId vertex) const {
  if (vertex >= static_cast<int>(subgraph_of_.size()) || subgraph_of_[vertex] < 0) {
    return std::nullopt;
  }
  return subgraph_of_[vertex];
}

void ActionGraph::AddVertex(VertexId vertex) {
  if (Contains(vertex)) {
    return;
  }
  subgraph_of_.resize(master_->topology().num_vertices(), -1);
  subgraph_of_[vertex] = static_cast<int>(subgraphs_.size());
  subgraphs_.emplace_back().AddVertex(vertex, master_->point(vertex));
}

void ActionGraph::Join(VertexId a, VertexId b) {
  const std::optional<int> subgraph_a = SubGraphOf(a);
  const std::optional<int> subgraph_b = SubGraphOf(b);
  if (!subgraph_a || !subgraph_b || *subgraph_a == *subgraph_b) {
    return;
  }
  int kept = *subgraph_a;
  int dissolved = *subgraph_b;
  if (subgraphs_[kept].vertices().size() < subgraphs_[dissolved].vertices().size()) {
    std::swap(kept, dissolved);
  }
  for (const VertexId vertex : subgraphs_[dissolved].vertices()) {
    subgraph_of_[vertex] = kept;
  }
  subgraphs_[kept].Append(subgraphs_[dissolved]);
  const int last = static_cast<int>(subgraphs_.size()) - 1;
  if (dissolved != last) {
    for (const VertexId vertex : subgraphs_[last].vertices()) {
      subgraph_of_[vertex] = dissolved;
    }
    subgraphs_[dissolved] = std::move(subgraphs_[last]);
  }
  subgraphs_.pop_back();
}

bool ActionGraph::Severed(const NewEdge& edge) const {
  const auto there = master_->FindEdge(action_, edge.from, edge.to);
  const auto back = master_->FindEdge(action_, edge.to, edge.from);
  const bool known = there || back;
  const bool alive = (there && !master_->topology().removed(*there)) ||
                     (back && !master_->topology().removed(*back));
  return known && !alive;
}

void ActionGraph::Rebuild() {
  subgraphs_.clear();
  for (VertexId vertex = 0; vertex < static_cast<int>(subgraph_of_.size()); ++vertex) {
    if (std::exchange(subgraph_of_[vertex], -1) >= 0) {
      AddVertex(vertex);
    }
  }
  for (const NewEdge& edge : edges_) {
    if (!Severed(edge)) {
      Join(edge.from, edge.to);
    }
  }
}

}  // namespace possibility::graph
