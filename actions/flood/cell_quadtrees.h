#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <stdexcept>
#include <vector>

namespace possibility::actions {

/// The cells [x0, x1) x [y0, y1) of one plane.
struct CellBlock {
  int plane = 0;
  int x0 = 0;
  int y0 = 0;
  int x1 = 0;
  int y1 = 0;

  static CellBlock Of(int plane, int x, int y) { return {plane, x, y, x + 1, y + 1}; }
  bool IsCell() const { return x1 == x0 + 1 && y1 == y0 + 1; }
  bool Contains(const CellBlock& other) const {
    return plane == other.plane && x0 <= other.x0 && y0 <= other.y0 && other.x1 <= x1 &&
           other.y1 <= y1;
  }
  bool operator==(const CellBlock&) const = default;
};

/// State of all cells of a block; kMixed: not the same for all, or unknown.
enum class BlockState { kClosed, kOpen, kMixed };

/// Thrown when cells would exceed their memory limit.
class TooManyCells : public std::runtime_error {
 public:
  TooManyCells() : std::runtime_error("too many cells") {}
};

/// Cells of several planes, nx x ny in each. They are judged only on demand, in the largest blocks
/// of equal cells (one quadtree per plane): memory grows with the boundary of the open cells, not
/// with the number of cells.
class CellQuadtrees {
 public:
  /// Whether the cells of a block are open. kMixed is allowed only for more than one cell. The
  /// answers for a cell and for every block that holds it must agree.
  using Judge = std::function<BlockState(const CellBlock&)>;
  using Lead = std::function<bool(const CellBlock&)>;
  using Enter = std::function<void(const CellBlock&)>;

  /// Largest number of cells along an axis, and of planes.
  static constexpr int kMostLevels = 28;
  static constexpr int kMostAlong = 1 << kMostLevels;

  /// `most_nodes`: limit for all trees together, 8 bytes each.
  /// @throws TooManyCells
  CellQuadtrees(int planes, int nx, int ny, std::int64_t most_nodes, Judge judge);

  /// Enters the open blocks that overlap `block`, lie in the grid, were not entered before and
  /// satisfy `leads_there`. Entered blocks are disjoint, and all cells of one count as entered.
  /// @throws TooManyCells
  void Offer(const CellBlock& block, const Lead& leads_there, const Enter& enter);

  /// Enters the cell whatever its state, together with the open block around it if there is one.
  /// @throws TooManyCells; std::out_of_range if the cell lies outside the grid.
  void Seed(int plane, int x, int y, const Enter& enter);

  /// Whether `block` holds a cell that is not judged yet, or is open and not entered.
  bool HasLeft(const CellBlock& block) const;

  std::int64_t judged() const { return judged_; }

 private:
  enum class State : std::uint8_t {
    kUnjudged,
    kClosed,
    kOpen,
    kEntered,
    kSplit,
    kSettled  ///< split, with nothing left to enter below
  };
  struct Node {
    std::int32_t first_child = -1;
    State state = State::kUnjudged;
  };
  /// A node and its square of cells.
  struct Place {
    std::int32_t node = 0;
    int plane = 0;
    int x = 0;
    int y = 0;
    int size = 0;
  };

  Place Root(int plane) const { return {plane, plane, 0, 0, size_}; }
  Place Child(const Place& parent, int index) const;
  CellBlock BlockOf(const Place& place) const;
  void JudgeNode(const Place& place);
  void Split(const Place& place, State state_of_children);
  void Offer(const Place& place, const CellBlock& block, const Lead& leads_there,
             const Enter& enter);
  std::optional<Place> OnlyChild(const Place& parent, const CellBlock& block) const;
  bool HasLeft(const Place& place, const CellBlock& block) const;
  bool IsDone(const Place& place) const;
  void SettleIfDone(const Place& place);

  int planes_;
  int nx_;
  int ny_;
  int size_ = 1;  ///< of a root's square
  std::int64_t most_nodes_;
  Judge judge_;
  std::vector<Node> nodes_;  ///< roots first
  std::int64_t judged_ = 0;
};

}  // namespace possibility::actions
