#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <deque>
#include <vector>

namespace possibility::actions {

/// Breadth-first flood over a regular grid of up to four dimensions whose cells are tested only
/// when the flood touches them.
class CellGrid {
 public:
  using Cell = std::array<int, 4>;

  explicit CellGrid(const Cell& size)
      : size_(size),
        states_(static_cast<size_t>(size[0]) * size[1] * size[2] * size[3], kUntested) {}

  const Cell& size() const { return size_; }
  std::int64_t tested() const { return tested_; }

  bool Contains(const Cell& cell) const {
    for (int i = 0; i < 4; ++i) {
      if (cell[i] < 0 || cell[i] >= size_[i]) return false;
    }
    return true;
  }

  /// Enters `cell` into the flood without a test.
  void Seed(const Cell& cell) {
    states_[Index(cell)] = kReached;
    queue_.push_back(cell);
  }

  /// Enters `cell` if it lies in the grid, was not reached before and `is_open(cell)`, which is
  /// asked once. `leads_there()`: whether this offer can be taken up; asked of cells that are open.
  template <typename Test, typename Lead>
  void Offer(const Cell& cell, const Test& is_open, const Lead& leads_there) {
    if (!Contains(cell)) return;
    std::uint8_t& state = states_[Index(cell)];
    if (state == kUntested) {
      ++tested_;
      state = is_open(cell) ? kOpen : kClosed;
    }
    if (state != kOpen || !leads_there()) return;
    state = kReached;
    queue_.push_back(cell);
  }
  template <typename Test>
  void Offer(const Cell& cell, const Test& is_open) {
    Offer(cell, is_open, [] { return true; });
  }

  bool Empty() const { return queue_.empty(); }
  Cell Pop() {
    const Cell cell = queue_.front();
    queue_.pop_front();
    return cell;
  }

  bool IsReached(const Cell& cell) const { return states_[Index(cell)] == kReached; }

 private:
  enum State : std::uint8_t { kUntested, kOpen, kReached, kClosed };

  size_t Index(const Cell& c) const {
    return ((static_cast<size_t>(c[0]) * size_[1] + c[1]) * size_[2] + c[2]) * size_[3] + c[3];
  }

  Cell size_;
  std::vector<std::uint8_t> states_;
  std::deque<Cell> queue_;
  std::int64_t tested_ = 0;
};

}  // namespace possibility::actions
