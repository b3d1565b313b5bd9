#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "graph/action/exploration_space.h"
#include "graph/structure/directed_graph.h"

namespace possibility::graph {

/// Finds the vertex closest to a point, in any metric. Every vertex stores its distances to a few
/// pivots. The triangle inequality then rules out most vertices without measuring their distance.
class NearestVertices {
 public:
  /// `space` must outlive this.
  explicit NearestVertices(const ExplorationSpace* space) : space_(space) {}

  void Insert(VertexId vertex, const Point& point);

  /// In insertion order.
  const std::vector<VertexId>& vertices() const { return vertices_; }

  /// The closest vertex that `admits` (any vertex if it is empty); the first inserted if several
  /// are equally close; nothing if there is none.
  using Filter = std::function<bool(VertexId)>;
  std::optional<VertexId> Closest(const Point& p, const Filter& admits = {}) const;

 private:
  static constexpr std::size_t kPivots = 6;
  static constexpr std::size_t kBlock = 64;            ///< vertices that are searched together
  using Block = Eigen::Array<float, kBlock, kPivots>;  ///< distances of vertices (rows) from pivots
  struct Best;

  void ChoosePivots();
  void Tabulate(std::size_t index);
  void LookThrough(std::size_t block, const Filter& admits, Best* best) const;

  const ExplorationSpace* space_;
  std::vector<VertexId> vertices_;
  std::vector<Point> points_;
  std::vector<Point> pivots_;
  std::vector<Block> blocks_;
  std::size_t next_choice_ = 64;  ///< number of vertices at which the pivots are chosen again
};

}  // namespace possibility::graph
