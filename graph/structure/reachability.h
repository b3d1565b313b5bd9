#pragma once

#include <vector>

#include "graph/structure/directed_graph.h"

namespace possibility::graph {

/// The vertices that a set of roots reaches along (or against) the edges of a graph, updated as
/// edges come and go. Holds a spanning forest of the reached vertices: a new edge costs what it
/// newly reaches, a removed edge only the subtree below it.
class Reachability {
 public:
  enum class Direction {
    kDownstream,  ///< reached from a root along the edges
    kUpstream,    ///< reaches a root along the edges
  };

  /// `graph` must outlive this.
  Reachability(const DirectedGraph* graph, Direction direction)
      : graph_(graph), direction_(direction) {}

  void AddRoot(VertexId vertex);

  bool Reached(VertexId vertex) const {
    return vertex < static_cast<int>(parent_.size()) && parent_[vertex] != kUnreached;
  }

  /// Call after an edge was added to or put back into the graph.
  void OnInserted(EdgeId edge);
  /// Call after an edge was removed from the graph.
  void OnRemoved(EdgeId edge);

 private:
  static constexpr EdgeId kUnreached = -2;
  static constexpr EdgeId kRoot = -1;

  VertexId Near(EdgeId edge) const;
  VertexId Far(EdgeId edge) const;
  const std::vector<EdgeId>& Leaving(VertexId vertex) const;
  const std::vector<EdgeId>& Arriving(VertexId vertex) const;

  void Grow();
  void SpreadFrom(std::vector<VertexId> frontier);
  std::vector<VertexId> CutSubtree(VertexId top);
  bool Reattach(VertexId vertex);

  const DirectedGraph* graph_;
  Direction direction_;
  std::vector<EdgeId> parent_;  ///< per vertex: the edge by which the forest reaches it
};

}  // namespace possibility::graph
