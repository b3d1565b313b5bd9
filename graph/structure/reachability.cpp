#include "graph/structure/reachability.h"

#include <utility>

namespace possibility::graph {

VertexId Reachability::Near(EdgeId edge) const {
  return direction_ == Direction::kDownstream ? graph_->from(edge) : graph_->to(edge);
}

VertexId Reachability::Far(EdgeId edge) const {
  return direction_ == Direction::kDownstream ? graph_->to(edge) : graph_->from(edge);
}

const std::vector<EdgeId>& Reachability::Leaving(VertexId vertex) const {
  return direction_ == Direction::kDownstream ? graph_->outgoing(vertex) : graph_->incoming(vertex);
}

const std::vector<EdgeId>& Reachability::Arriving(VertexId vertex) const {
  return direction_ == Direction::kDownstream ? graph_->incoming(vertex) : graph_->outgoing(vertex);
}

void Reachability::Grow() { parent_.resize(graph_->num_vertices(), kUnreached); }

void Reachability::AddRoot(VertexId vertex) {
  Grow();
  const bool was_reached = parent_[vertex] != kUnreached;
  parent_[vertex] = kRoot;
  if (!was_reached) {
    SpreadFrom({vertex});
  }
}

void Reachability::OnInserted(EdgeId edge) {
  Grow();
  const VertexId far = Far(edge);
  if (parent_[Near(edge)] != kUnreached && parent_[far] == kUnreached) {
    parent_[far] = edge;
    SpreadFrom({far});
  }
}

void Reachability::OnRemoved(EdgeId edge) {
  Grow();
  if (parent_[Far(edge)] != edge) {
    return;
  }
  std::vector<VertexId> reattached;
  for (const VertexId vertex : CutSubtree(Far(edge))) {
    if (Reattach(vertex)) {
      reattached.push_back(vertex);
    }
  }
  SpreadFrom(std::move(reattached));
}

void Reachability::SpreadFrom(std::vector<VertexId> frontier) {
  while (!frontier.empty()) {
    const VertexId vertex = frontier.back();
    frontier.pop_back();
    for (const EdgeId edge : Leaving(vertex)) {
      const VertexId far = Far(edge);
      if (!graph_->removed(edge) && parent_[far] == kUnreached) {
        parent_[far] = edge;
        frontier.push_back(far);
      }
    }
  }
}

std::vector<VertexId> Reachability::CutSubtree(VertexId top) {
  std::vector<VertexId> subtree = {top};
  parent_[top] = kUnreached;
  for (std::size_t i = 0; i < subtree.size(); ++i) {
    for (const EdgeId edge : Leaving(subtree[i])) {
      const VertexId far = Far(edge);
      if (parent_[far] == edge) {
        parent_[far] = kUnreached;
        subtree.push_back(far);
      }
    }
  }
  return subtree;
}

bool Reachability::Reattach(VertexId vertex) {
  for (const EdgeId edge : Arriving(vertex)) {
    if (!graph_->removed(edge) && parent_[Near(edge)] != kUnreached) {
      parent_[vertex] = edge;
      return true;
    }
  }
  return false;
}

}  // namespace possibility::graph
