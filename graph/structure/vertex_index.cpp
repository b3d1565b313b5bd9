#include "graph/structure/vertex_index.h"

namespace possibility::graph {

void VertexIndex::Insert(VertexId vertex, const Point& point) {
  by_distance_.emplace(space_->Distance(pivot_, point), Entry{vertex, point});
}

std::optional<VertexId> VertexIndex::Find(const Point& point) const {
  // Twice the tolerance, and a little more for large distances: rounding must not hide a vertex.
  const double distance = space_->Distance(pivot_, point);
  const double margin = 2 * kSamePointDistance + 1e-14 * distance;
  std::optional<VertexId> found;
  const auto end = by_distance_.upper_bound(distance + margin);
  for (auto it = by_distance_.lower_bound(distance - margin); it != end; ++it) {
    const Entry& entry = it->second;
    if ((!found || entry.vertex < *found) &&
        space_->Distance(entry.point, point) < kSamePointDistance) {
      found = entry.vertex;
    }
  }
  return found;
}

}  // namespace possibility::graph
