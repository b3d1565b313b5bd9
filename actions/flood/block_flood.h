#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <queue>
#include <vector>

#include "actions/flood/cell_quadtrees.h"
#include "common/cancellation_token.h"

namespace possibility::actions {

/// How a flood ended. kCutShort: at its limits, without a result.
enum class FloodEnd { kNothingLeft, kGoal, kCutShort };

struct FloodLimits {
  /// Largest number of quadtree nodes, 8 bytes each. The flood keeps at most 36 more bytes per
  /// reached block: below 1 GB in all.
  static constexpr std::int64_t kMostNodes = 20'000'000;

  std::int64_t most_judged = kMostNodes;  ///< blocks of cells
  CancellationToken cancellation = {};    ///< asked for every block judged
};

/// A flood over cells, in blocks as large as possible whose cells are all open, blocks close to a
/// goal first. The set finally reached does not depend on that order.
class BlockFlood {
 public:
  struct Reached {
    CellBlock block;
    std::int32_t from = -1;  ///< index of the block that offered it; -1: none
  };
  using Lead = CellQuadtrees::Lead;

  /// Run is cut short if the grid is too large.
  BlockFlood(int planes, double nx, double ny, CellQuadtrees::Judge judge, FloodLimits limits);

  /// Floods from the cell of `seed`. `distance`: from a block to the goals. `expand`: offers the
  /// neighbours of a block. `expand_late`: offers further neighbours once nothing else is left to
  /// expand.
  FloodEnd Run(const CellBlock& seed, const std::function<bool(const CellBlock&)>& is_goal,
               const std::function<double(const CellBlock&)>& distance,
               const std::function<void(const CellBlock&)>& expand,
               const std::function<void(const CellBlock&)>& expand_late);

  /// For `expand` and `expand_late`. `leads_there`: whether the offer applies to an open block;
  /// empty: always.
  void Offer(const CellBlock& block, const Lead& leads_there = {});
  /// Whether an offer of the block might enter new cells.
  bool HasLeft(const CellBlock& block) const { return cells_->HasLeft(block); }

  /// Disjoint blocks in the order of reaching.
  const std::deque<Reached>& reached() const { return reached_; }
  std::int64_t judged() const { return judged_; }
  /// Blocks from the seed to the goal's block, after FloodEnd::kGoal.
  std::vector<CellBlock> WayToGoal() const;

 private:
  struct Candidate {
    float distance = 0;
    std::int32_t reached = 0;
    bool operator<(const Candidate& other) const {
      return distance != other.distance ? distance > other.distance : reached > other.reached;
    }
  };

  BlockState Judge(const CellBlock& block);
  void Enter(const CellBlock& block);

  CellQuadtrees::Judge judge_;
  FloodLimits limits_;
  int planes_;
  double nx_;
  double ny_;
  CellQuadtrees* cells_ = nullptr;  ///< while running
  std::function<double(const CellBlock&)> distance_;
  std::deque<Reached> reached_;  ///< a deque: growing never copies, and there may be many
  std::priority_queue<Candidate> open_;
  std::deque<std::int32_t> late_;
  std::int32_t current_ = -1;  ///< being expanded
  std::int32_t goal_ = -1;
  std::int64_t judged_ = 0;
};

}  // namespace possibility::actions
