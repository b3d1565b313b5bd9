#include "graph/structure/directed_graph.h"

namespace possibility::graph {

VertexId DirectedGraph::AddVertex() {
  outgoing_.emplace_back();
  incoming_.emplace_back();
  return num_vertices() - 1;
}

EdgeId DirectedGraph::AddEdge(VertexId from, VertexId to) {
  const EdgeId edge = num_edges();
  from_.push_back(from);
  to_.push_back(to);
  removed_.push_back(false);
  outgoing_[from].push_back(edge);
  incoming_[to].push_back(edge);
  return edge;
}

}  // namespace possibility::graph
