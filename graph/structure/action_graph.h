#pragma once

#include <optional>
#include <vector>

#include "graph/structure/nearest_vertices.h"
#include "graph/structure/possibility_graph.h"

namespace possibility::graph {

/// Vertices of one action that its own edges connect, in either direction.
using SubGraph = std::vector<VertexId>;

/// Gamma_a: the vertices and edges of one action, as a set of subgraphs. Edges removed from the
/// master graph do not connect a subgraph.
class ActionGraph {
 public:
  /// `master` must outlive this.
  ActionGraph(int action, const PossibilityGraph* master)
      : action_(action), master_(master), nearest_(&master->space()) {}

  bool Contains(VertexId vertex) const { return SubGraphOf(vertex).has_value(); }

  int num_vertices() const { return static_cast<int>(nearest_.vertices().size()); }

  void Append(const NewElements& elements);

  const std::vector<SubGraph>& SubGraphs();

  /// The closest vertex; nothing if the graph is empty.
  std::optional<VertexId> FindClosestVertexTo(const Point& p) const { return nearest_.Closest(p); }
  /// A random vertex; nothing if the graph is empty.
  std::optional<VertexId> RandomVertex(RandomGenerator* generator) const;
  /// The closest vertex that `admits` and that is not in the subgraph of `v`; nothing if there is
  /// none.
  std::optional<VertexId> FindClosestVertexTo(const Point& p, VertexId v,
                                              const NearestVertices::Filter& admits);

 private:
  std::optional<int> SubGraphOf(VertexId vertex) const;
  void BeginSubGraph(VertexId vertex);
  void Join(VertexId a, VertexId b);
  bool Severed(const NewEdge& edge) const;
  void Rebuild();

  int action_;
  const PossibilityGraph* master_;
  std::vector<int> subgraph_of_;  ///< per master vertex: index into subgraphs_, or -1
  std::vector<SubGraph> subgraphs_;
  std::vector<NewEdge> edges_;
  NearestVertices nearest_;
  int changes_seen_ = 0;
};

}  // namespace possibility::graph
