#include "graph/structure/action_graph.h"

#include <utility>

#include "graph/action/random.h"

namespace possibility::graph {

void ActionGraph::Append(const NewElements& elements) {
  for (const VertexId vertex : elements.vertices) {
    if (!Contains(vertex)) {
      BeginSubGraph(vertex);
      nearest_.Insert(vertex, master_->point(vertex));
    }
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

std::optional<VertexId> ActionGraph::RandomVertex(RandomGenerator* generator) const {
  const std::vector<VertexId>& all = nearest_.vertices();
  if (all.empty()) return std::nullopt;
  return all[UniformIndex(all.size(), generator)];
}

std::optional<VertexId> ActionGraph::FindClosestVertexTo(const Point& p, VertexId v,
                                                         const NearestVertices::Filter& admits) {
  SubGraphs();
  const int own = subgraph_of_[v];
  return nearest_.Closest(
      p, [&](VertexId other) { return subgraph_of_[other] != own && admits(other); });
}

void ActionGraph::BeginSubGraph(VertexId vertex) {
  subgraph_of_.resize(master_->topology().num_vertices(), -1);
  subgraph_of_[vertex] = static_cast<int>(subgraphs_.size());
  subgraphs_.push_back({vertex});
}

void ActionGraph::Join(VertexId a, VertexId b) {
  const std::optional<int> subgraph_a = SubGraphOf(a);
  const std::optional<int> subgraph_b = SubGraphOf(b);
  if (!subgraph_a || !subgraph_b || *subgraph_a == *subgraph_b) {
    return;
  }
  int kept = *subgraph_a;
  int dissolved = *subgraph_b;
  if (subgraphs_[kept].size() < subgraphs_[dissolved].size()) {
    std::swap(kept, dissolved);
  }
  for (const VertexId vertex : subgraphs_[dissolved]) {
    subgraph_of_[vertex] = kept;
  }
  subgraphs_[kept].insert(subgraphs_[kept].end(), subgraphs_[dissolved].begin(),
                          subgraphs_[dissolved].end());
  const int last = static_cast<int>(subgraphs_.size()) - 1;
  if (dissolved != last) {
    for (const VertexId vertex : subgraphs_[last]) {
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
      BeginSubGraph(vertex);
    }
  }
  for (const NewEdge& edge : edges_) {
    if (!Severed(edge)) {
      Join(edge.from, edge.to);
    }
  }
}

}  // namespace possibility::graph
