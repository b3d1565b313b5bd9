#include "actions/flood/cell_outline.h"

#include <algorithm>
#include <array>
#include <unordered_set>

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

/// The edges of a mask's boundary that are not yet part of a polygon, with the mask's cells to
/// their left.
class BoundaryEdges {
 public:
  explicit BoundaryEdges(int nx) : stride_(nx + 1) {}

  void Add(int x, int y, int direction) {
    const std::int64_t index = Index({x, y}, direction);
    edges_.insert(index);
    if (direction == 0) ahead_.push_back(index);
  }
  bool Take(const Vector2i& corner, int direction) {
    return edges_.erase(Index(corner, direction)) != 0;
  }

  /// Beginnings of edges ahead along x, ordered by y, then x.
  std::vector<Vector2i> Beginnings() {
    std::sort(ahead_.begin(), ahead_.end());
    std::vector<Vector2i> beginnings;
    beginnings.reserve(ahead_.size());
    for (const std::int64_t index : ahead_) {
      const std::int64_t corner = index / kNumDirections;
      beginnings.emplace_back(static_cast<int>(corner % stride_),
                              static_cast<int>(corner / stride_));
    }
    return beginnings;
  }

 private:
  std::int64_t Index(const Vector2i& corner, int direction) const {
    return kNumDirections * (corner.y() * stride_ + corner.x()) + direction;
  }

  std::int64_t stride_;
  std::unordered_set<std::int64_t> edges_;
  std::vector<std::int64_t> ahead_;
};

/// The corners of the polygon that contains the edge from `begin`, which is already taken.
std::vector<Vector2i> WalkAround(const Vector2i& begin, int first, BoundaryEdges* edges) {
  std::vector<Vector2i> corners;
  Vector2i corner = begin;
  int direction = first;
  while (true) {
    corner += Step(direction);
    // Left, straight on, right: left first, so that cells that share only this corner stay
    // separate.
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

CellMask::CellMask(int nx, int ny) : nx_(nx), ny_(ny), nodes_(1) {
  while (size_ < std::max(nx, ny)) size_ *= 2;
}

CellMask::Rectangle CellMask::InGrid(const Place& place) const {
  return {place.x, place.y, std::min(place.x + place.size, nx_),
          std::min(place.y + place.size, ny_)};
}

CellMask::Place CellMask::Child(const Place& parent, int index) const {
  const int half = parent.size / 2;
  return {nodes_[parent.node].first_child + index, parent.x + (index & 1 ? half : 0),
          parent.y + (index & 2 ? half : 0), half};
}

void CellMask::Add(int x0, int y0, int x1, int y1) { Add({0, 0, 0, size_}, {x0, y0, x1, y1}); }

void CellMask::Add(const Place& place, const Rectangle& rectangle) {
  const Rectangle own = InGrid(place);
  if (own.x0 >= std::min(own.x1, rectangle.x1) || own.y0 >= std::min(own.y1, rectangle.y1) ||
      own.x1 <= rectangle.x0 || own.y1 <= rectangle.y0 ||
      nodes_[place.node].state == State::kFull) {
    return;
  }
  if (rectangle.x0 <= own.x0 && rectangle.y0 <= own.y0 && own.x1 <= rectangle.x1 &&
      own.y1 <= rectangle.y1) {
    nodes_[place.node].state = State::kFull;
    return;
  }
  if (nodes_[place.node].state == State::kEmpty) {
    nodes_[place.node] = {static_cast<std::int32_t>(nodes_.size()), State::kSplit};
    nodes_.resize(nodes_.size() + 4);
  }
  bool is_full = true;
  for (int i = 0; i < 4; ++i) {
    const Place child = Child(place, i);
    Add(child, rectangle);
    is_full =
        is_full && (nodes_[child.node].state == State::kFull || child.x >= nx_ || child.y >= ny_);
  }
  if (is_full) nodes_[place.node].state = State::kFull;
}

bool CellMask::Contains(int x, int y) const {
  if (x < 0 || x >= nx_ || y < 0 || y >= ny_) return false;
  bool is_empty = false;
  VisitEmptyCells({x, y, x + 1, y + 1}, [&](int, int) { is_empty = true; });
  return !is_empty;
}

/// Visits all full rectangles.
template <typename Visit>
void CellMask::VisitFull(const Place& place, const Visit& visit) const {
  const Node& node = nodes_[place.node];
  if (node.state == State::kFull) visit(InGrid(place));
  if (node.state != State::kSplit) return;
  for (int i = 0; i < 4; ++i) VisitFull(Child(place, i), visit);
}

template <typename Visit>
void CellMask::VisitEmptyCells(const Place& place, const Rectangle& strip,
                               const Visit& visit) const {
  const Node& node = nodes_[place.node];
  const Rectangle own = InGrid(place);
  const Rectangle common{std::max(own.x0, strip.x0), std::max(own.y0, strip.y0),
                         std::min(own.x1, strip.x1), std::min(own.y1, strip.y1)};
  if (node.state == State::kFull || common.x0 >= common.x1 || common.y0 >= common.y1) return;
  if (node.state == State::kSplit) {
    for (int i = 0; i < 4; ++i) VisitEmptyCells(Child(place, i), strip, visit);
    return;
  }
  for (int y = common.y0; y < common.y1; ++y) {
    for (int x = common.x0; x < common.x1; ++x) visit(x, y);
  }
}

/// `strip`: beside a part of the grid, inside or outside the grid; cells outside are empty.
template <typename Visit>
void CellMask::VisitEmptyCells(const Rectangle& strip, const Visit& visit) const {
  if (strip.x0 >= 0 && strip.y0 >= 0 && strip.x1 <= nx_ && strip.y1 <= ny_) {
    return VisitEmptyCells({0, 0, 0, size_}, strip, visit);
  }
  for (int y = strip.y0; y < strip.y1; ++y) {
    for (int x = strip.x0; x < strip.x1; ++x) visit(x, y);
  }
}

std::vector<std::vector<Vector2i>> CellMask::Outlines(const CancellationToken& cancellation) const {
  BoundaryEdges edges(nx_);
  bool goes_on = true;
  VisitFull({0, 0, 0, size_}, [&](const Rectangle& full) {
    goes_on = goes_on && cancellation.Proceed();
    if (!goes_on) return;
    VisitEmptyCells({full.x0, full.y0 - 1, full.x1, full.y0},
                    [&](int x, int y) { edges.Add(x, y + 1, 0); });
    VisitEmptyCells({full.x1, full.y0, full.x1 + 1, full.y1},
                    [&](int x, int y) { edges.Add(x, y, 1); });
    VisitEmptyCells({full.x0, full.y1, full.x1, full.y1 + 1},
                    [&](int x, int y) { edges.Add(x + 1, y, 2); });
    VisitEmptyCells({full.x0 - 1, full.y0, full.x0, full.y1},
                    [&](int x, int y) { edges.Add(x + 1, y + 1, 3); });
  });
  if (!goes_on) return {};
  std::vector<std::vector<Vector2i>> outlines;
  for (const Vector2i& corner : edges.Beginnings()) {
    if (edges.Take(corner, 0)) outlines.push_back(WalkAround(corner, 0, &edges));
  }
  return outlines;
}

}  // namespace possibility::actions
