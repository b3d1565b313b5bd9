#include "actions/flood/cell_quadtrees.h"

#include <algorithm>
#include <array>
#include <utility>

namespace possibility::actions {
namespace {

bool Overlap(const CellBlock& a, const CellBlock& b) {
  return a.x0 < b.x1 && b.x0 < a.x1 && a.y0 < b.y1 && b.y0 < a.y1;
}

}  // namespace

CellQuadtrees::CellQuadtrees(int planes, int nx, int ny, std::int64_t most_nodes, Judge judge)
    : planes_(planes), nx_(nx), ny_(ny), most_nodes_(most_nodes), judge_(std::move(judge)) {
  if (planes > most_nodes || std::max({planes, nx, ny}) > kMostAlong) throw TooManyCells();
  while (size_ < std::max(nx, ny)) size_ *= 2;
  nodes_.resize(static_cast<std::size_t>(planes));
}

CellQuadtrees::Place CellQuadtrees::Child(const Place& parent, int index) const {
  const int half = parent.size / 2;
  return {nodes_[parent.node].first_child + index, parent.plane, parent.x + (index & 1 ? half : 0),
          parent.y + (index & 2 ? half : 0), half};
}

/// The part of the node's square that lies in the grid.
CellBlock CellQuadtrees::BlockOf(const Place& place) const {
  return {place.plane, place.x, place.y, std::min(place.x + place.size, nx_),
          std::min(place.y + place.size, ny_)};
}

void CellQuadtrees::Split(const Place& place, State state_of_children) {
  if (static_cast<std::int64_t>(nodes_.size()) + 4 > most_nodes_) throw TooManyCells();
  nodes_[place.node] = {static_cast<std::int32_t>(nodes_.size()), State::kSplit};
  for (int i = 0; i < 4; ++i) {
    nodes_.push_back({-1, state_of_children});
    const Place child = Child(place, i);
    if (child.x >= nx_ || child.y >= ny_) nodes_.back().state = State::kClosed;
  }
}

void CellQuadtrees::JudgeNode(const Place& place) {
  ++judged_;
  switch (judge_(BlockOf(place))) {
    case BlockState::kClosed:
      nodes_[place.node].state = State::kClosed;
      break;
    case BlockState::kOpen:
      nodes_[place.node].state = State::kOpen;
      break;
    case BlockState::kMixed:
      Split(place, State::kUnjudged);
      break;
  }
}

bool CellQuadtrees::IsDone(const Place& place) const {
  const State state = nodes_[place.node].state;
  return state == State::kClosed || state == State::kEntered || state == State::kSettled;
}

void CellQuadtrees::SettleIfDone(const Place& place) {
  for (int i = 0; i < 4; ++i) {
    if (!IsDone(Child(place, i))) return;
  }
  nodes_[place.node].state = State::kSettled;
}

/// The child that holds all of `block` within the grid; none if no single child does.
std::optional<CellQuadtrees::Place> CellQuadtrees::OnlyChild(const Place& parent,
                                                             const CellBlock& block) const {
  const int x = parent.x + parent.size / 2, y = parent.y + parent.size / 2;
  const bool is_right = block.x0 >= x, is_upper = block.y0 >= y;
  if (!is_right && std::min(block.x1, nx_) > x) return std::nullopt;
  if (!is_upper && std::min(block.y1, ny_) > y) return std::nullopt;
  return Child(parent, (is_right ? 1 : 0) + (is_upper ? 2 : 0));
}

bool CellQuadtrees::HasLeft(const CellBlock& block) const {
  if (block.plane < 0 || block.plane >= planes_) return false;
  Place place = Root(block.plane);
  while (nodes_[place.node].state == State::kSplit) {
    const std::optional<Place> child = OnlyChild(place, block);
    if (!child) break;
    place = *child;
  }
  return HasLeft(place, block);
}

bool CellQuadtrees::HasLeft(const Place& place, const CellBlock& block) const {
  if (!Overlap(BlockOf(place), block)) return false;
  const State state = nodes_[place.node].state;
  if (state != State::kSplit) return state == State::kUnjudged || state == State::kOpen;
  for (int i = 0; i < 4; ++i) {
    if (HasLeft(Child(place, i), block)) return true;
  }
  return false;
}

void CellQuadtrees::Offer(const CellBlock& block, const Lead& leads_there, const Enter& enter) {
  if (block.plane < 0 || block.plane >= planes_) return;
  std::array<Place, kMostLevels> way;
  int length = 0;
  Place place = Root(block.plane);
  while (nodes_[place.node].state == State::kSplit) {
    const std::optional<Place> child = OnlyChild(place, block);
    if (!child) break;
    way[length++] = place;
    place = *child;
  }
  Offer(place, block, leads_there, enter);
  while (length > 0 && IsDone(place)) {
    place = way[--length];
    SettleIfDone(place);
  }
}

void CellQuadtrees::Offer(const Place& place, const CellBlock& block, const Lead& leads_there,
                          const Enter& enter) {
  const CellBlock own = BlockOf(place);
  if (!Overlap(own, block)) return;
  if (nodes_[place.node].state == State::kUnjudged) JudgeNode(place);
  if (nodes_[place.node].state == State::kOpen && (!leads_there || leads_there(own))) {
    nodes_[place.node].state = State::kEntered;
    enter(own);
  }
  if (nodes_[place.node].state != State::kSplit) return;
  for (int i = 0; i < 4; ++i) Offer(Child(place, i), block, leads_there, enter);
  SettleIfDone(place);
}

void CellQuadtrees::Seed(int plane, int x, int y, const Enter& enter) {
  if (plane < 0 || plane >= planes_ || x < 0 || x >= nx_ || y < 0 || y >= ny_) {
    throw std::out_of_range("a flood begins outside its cells");
  }
  Place place = Root(plane);
  while (true) {
    if (nodes_[place.node].state == State::kUnjudged) JudgeNode(place);
    const State state = nodes_[place.node].state;
    const bool is_cell = place.size == 1;
    if (state == State::kOpen || (state == State::kClosed && is_cell)) {
      nodes_[place.node].state = State::kEntered;
      return enter(BlockOf(place));
    }
    if (state == State::kEntered || is_cell) return;
    if (state == State::kClosed) Split(place, State::kClosed);
    const int half = place.size / 2;
    place = Child(place, (x >= place.x + half ? 1 : 0) + (y >= place.y + half ? 2 : 0));
  }
}

}  // namespace possibility::actions
