#pragma once

#include <vector>

namespace possibility::graph {

/// Vertices and edges are numbered from 0 in the order they were added, and keep their numbers.
using VertexId = int;
using EdgeId = int;

/// The topology of a graph. A removed edge keeps its number and its place, so that it can be
/// reinserted and its earlier presence stays known.
class DirectedGraph {
 public:
  VertexId AddVertex();
  EdgeId AddEdge(VertexId from, VertexId to);

  void Remove(EdgeId edge) { removed_[edge] = true; }
  void Reinsert(EdgeId edge) { removed_[edge] = false; }

  int num_vertices() const { return static_cast<int>(outgoing_.size()); }
  int num_edges() const { return static_cast<int>(from_.size()); }

  VertexId from(EdgeId edge) const { return from_[edge]; }
  VertexId to(EdgeId edge) const { return to_[edge]; }
  bool removed(EdgeId edge) const { return removed_[edge]; }

  /// Edges at a vertex, including removed ones, in the order they were added.
  const std::vector<EdgeId>& outgoing(VertexId vertex) const { return outgoing_[vertex]; }
  const std::vector<EdgeId>& incoming(VertexId vertex) const { return incoming_[vertex]; }

 private:
  std::vector<VertexId> from_;
  std::vector<VertexId> to_;
  std::vector<bool> removed_;
  std::vector<std::vector<EdgeId>> outgoing_;
  std::vector<std::vector<EdgeId>> incoming_;
};

}  // namespace possibility::graph
