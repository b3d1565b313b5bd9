#pragma once

#include <map>
#include <optional>
#include <vector>

#include "graph/action/exploration_space.h"
#include "graph/structure/directed_graph.h"

namespace possibility::graph {

/// Points closer than this are the same point of E.
inline constexpr double kSamePointDistance = 1e-9;

/// Finds the vertex at a given point. Vertices are sorted by their distance from a fixed pivot. By
/// the triangle inequality only vertices at nearly the same distance can be at the same point, so a
/// look-up measures few distances, in any metric.
class VertexIndex {
 public:
  /// `space` must outlive this.
  VertexIndex(const ExplorationSpace* space, const Point& pivot) : space_(space), pivot_(pivot) {}

  void Insert(VertexId vertex, const Point& point);

  /// The vertex at `point`, the first inserted if there are several.
  std::optional<VertexId> Find(const Point& point) const;

 private:
  struct Entry {
    VertexId vertex;
    Point point;
  };
  const ExplorationSpace* space_;
  Point pivot_;
  std::multimap<double, Entry> by_distance_;
};

}  // namespace possibility::graph
