#pragma once

#include <optional>
#include <vector>

#include "graph/possibility_graph.h"

namespace possibility::graph {

/// Vertices of one action that its own edges join together, whatever their direction.
class SubGraph {
 public:
  struct Closest {
    VertexId vertex = 0;
    double distance = 0;
  };

  void AddVertex(VertexId vertex, const Point& point);
  /// Takes over the vertices of another subgraph.
  void Append(const SubGraph& other);

  const std::vector<VertexId>& vertices() const { return vertices_; }

  Closest FindClosestVertexTo(const Point& p, const ExplorationSpace& space) const;

 private:
  std::vector<VertexId> vertices_;
  std::vector<Point> points_;  ///< of the vertices, side by side for the linear scan
};

/// Gamma_a: the vertices and edges of one action, as a set of subgraphs. Edges that were removed
/// from the master graph hold no subgraph together.
class ActionGraph {
 public:
  /// `master` must outlive this.
  ActionGraph(int action, const PossibilityGraph* master) : action_(action), master_(master) {}

  bool Contains(VertexId vertex) const { return SubGraphOf(vertex).has_value(); }

  void Append(const NewElements& elements);

  const std::vector<SubGraph>& SubGraphs();

 private:
  std::optional<int> SubGraphOf(VertexId vertex) const;
  void AddVertex(VertexId vertex);
  void Join(VertexId a, VertexId b);
  bool Severed(const NewEdge& edge) const;
  void Rebuild();

  int action_;
  const PossibilityGraph* master_;
  std::vector<int> subgraph_of_;  ///< per master vertex: index into subgraphs_, or -1
  std::vector<SubGraph> subgraphs_;
  std::vector<NewEdge> edges_;
  int changes_seen_ = 0;
};

}  // namespace possibility::graph
