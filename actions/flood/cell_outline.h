#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "common/cancellation_token.h"

namespace possibility::actions {

/// A set of cells of an nx x ny grid, stored as a quadtree: memory grows with its boundary.
class CellMask {
 public:
  CellMask(int nx, int ny);

  void Add(int x, int y) { Add(x, y, x + 1, y + 1); }
  /// Adds [x0, x1) x [y0, y1), clipped to the grid.
  void Add(int x0, int y0, int x1, int y1);
  bool Contains(int x, int y) const;

  /// Closed polygons along the edges of cells, corners only, in units of cells: counter-clockwise
  /// around parts, clockwise around holes. Cells that only share a corner are not connected.
  /// Polygons may meet at corners, but never cross. No polygons once cancelled.
  std::vector<std::vector<Eigen::Vector2i>> Outlines(
      const CancellationToken& cancellation = {}) const;

 private:
  enum class State : std::uint8_t { kEmpty, kFull, kSplit };
  struct Node {
    std::int32_t first_child = -1;
    State state = State::kEmpty;
  };
  /// [x0, x1) x [y0, y1).
  struct Rectangle {
    int x0;
    int y0;
    int x1;
    int y1;
  };
  /// A node and its square.
  struct Place {
    std::int32_t node;
    int x;
    int y;
    int size;
  };

  Rectangle InGrid(const Place& place) const;
  Place Child(const Place& parent, int index) const;
  void Add(const Place& place, const Rectangle& rectangle);
  template <typename Visit>
  void VisitFull(const Place& place, const Visit& visit) const;
  template <typename Visit>
  void VisitEmptyCells(const Place& place, const Rectangle& strip, const Visit& visit) const;
  template <typename Visit>
  void VisitEmptyCells(const Rectangle& strip, const Visit& visit) const;

  int nx_;
  int ny_;
  int size_ = 1;
  std::vector<Node> nodes_;  ///< the root first
};

}  // namespace possibility::actions
