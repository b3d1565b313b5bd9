#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace possibility::actions {

/// Some of the cells of a grid of nx x ny.
class CellMask {
 public:
  CellMask(int nx, int ny) : nx_(nx), ny_(ny), cells_(static_cast<size_t>(nx) * ny, 0) {}

  /// (x, y) must be a cell of the grid.
  void Add(int x, int y) { cells_[Index(x, y)] = 1; }
  bool Contains(int x, int y) const {
    return x >= 0 && x < nx_ && y >= 0 && y < ny_ && cells_[Index(x, y)] != 0;
  }

  /// Closed polygons along the edges of cells, corners only, in units of cells: around every part
  /// counter-clockwise, around every hole in it clockwise. Cells that only share a corner do not
  /// belong together. Polygons may meet at corners, but never cross.
  std::vector<std::vector<Eigen::Vector2i>> Outlines() const;

 private:
  size_t Index(int x, int y) const { return static_cast<size_t>(y) * nx_ + x; }

  int nx_;
  int ny_;
  std::vector<std::uint8_t> cells_;
};

}  // namespace possibility::actions
