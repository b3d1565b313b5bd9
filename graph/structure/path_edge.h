#pragma once

#include "graph/action/action.h"
#include "graph/structure/directed_graph.h"

namespace possibility::graph {

/// One edge of a path: its action and its points.
struct PathEdge {
  int action = 0;
  Edge points;
  VertexId from = -1;  ///< of GraphSnapshot; -1 if the edge was only proposed
  VertexId to = -1;    ///< likewise
};

}  // namespace possibility::graph
