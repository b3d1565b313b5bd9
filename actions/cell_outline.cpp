#include "actions/cell_outline.h"

#include <array>

namespace possibility::actions {
namespace {

using Eigen::Vector2i;

/// Directions: ahead along x, along y, back along x, back along y. The next one is a turn left.
constexpr int kNumDirections = 4;

Vector2i Step(int direction) {
  static constexpr std::array<std::array<int, 2>, kNumDirections> kSteps = {
      {{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
  return {kSteps[direction][0], kSteps[direction][1]};
}

/// The edges of a mask's boundary that have not been walked along yet, its cells to their left.
class BoundaryEdges {
 public:
  BoundaryEdges(int nx, int ny)
      : stride_(nx + 1), edges_(kNumDirections * static_cast<size_t>(stride_) * (ny + 1), 0) {}

  void Add(const Vector2i& corner, int direction) { edges_[Index(corner, direction)] = 1; }
  bool Take(const Vector2i& corner, int direction) {
    std::uint8_t& edge = edges_[Index(corner, direction)];
    const bool was_there = edge != 0;
    edge = 0;
    return was_there;
  }

 private:
  size_t Index(const Vector2i& corner, int direction) const {
    return kNumDirections * (static_cast<size_t>(corner.y()) * stride_ + corner.x()) + direction;
  }

  int stride_;
  std::vector<std::uint8_t> edges_;
};

/// The corners of the polygon that the edge from `begin`, taken already, is part of.
std::vector<Vector2i> WalkAround(const Vector2i& begin, int first, BoundaryEdges* edges) {
  std::vector<Vector2i> corners;
  Vector2i corner = begin;
  int direction = first;
  while (true) {
    corner += Step(direction);
    // Left, straight on, right: where two cells share only this corner, we stay with ours.
    for (const int turn : {1, 0, 3}) {
      const int next = (direction + turn) % kNumDirections;
      const bool is_closed = corner == begin && next == first;
      if (!is_closed && !edges->Take(corner, next)) continue;
      if (turn != 0) corners.push_back(corner);
      if (is_closed) return corners;
      direction = next;
      break;
    }
  }
}

}  // namespace

std::vector<std::vector<Vector2i>> CellMask::Outlines() const {
  BoundaryEdges edges(nx_, ny_);
  for (int y = 0; y < ny_; ++y) {
    for (int x = 0; x < nx_; ++x) {
      if (!Contains(x, y)) continue;
      if (!Contains(x, y - 1)) edges.Add({x, y}, 0);
      if (!Contains(x + 1, y)) edges.Add({x + 1, y}, 1);
      if (!Contains(x, y + 1)) edges.Add({x + 1, y + 1}, 2);
      if (!Contains(x - 1, y)) edges.Add({x, y + 1}, 3);
    }
  }
  std::vector<std::vector<Vector2i>> outlines;
  for (int y = 0; y <= ny_; ++y) {
    for (int x = 0; x <= nx_; ++x) {
      if (edges.Take({x, y}, 0)) outlines.push_back(WalkAround({x, y}, 0, &edges));
    }
  }
  return outlines;
}

}  // namespace possibility::actions
