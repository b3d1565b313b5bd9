#pragma once

#include <Eigen/Core>
#include <deque>
#include <vector>

#include "actions/conditions/locomotion_model.h"
#include "actions/flood/block_flood.h"
#include "common/cancellation_token.h"

namespace possibility::actions {

/// The place reached by a flood that is closest to any goal.
struct ClosestApproach {
  Eigen::Vector2d point = Eigen::Vector2d::Zero();  ///< m
  double distance = 0;                              ///< from that goal, m
  CellBlock cell = {};
};

/// Blocks of cells in the world, seen from above.
class BlocksFromAbove {
 public:
  /// The cells are of `size` (m), the first begins at `origin`. `goals` must outlive it.
  BlocksFromAbove(const Eigen::Vector2d& origin, const Eigen::Vector2d& size,
                  const std::vector<GroundedStance>& goals)
      : origin_(origin), size_(size), goals_(goals) {}

  /// Distance of the nearest cell centre from the nearest goal, m.
  double Distance(const CellBlock& block) const { return Closest(block).distance; }
  ClosestApproach ClosestOf(const std::deque<BlockFlood::Reached>& reached) const;

  /// Outlines of the union of all blocks over all planes, on a grid of `num_cells`; none once
  /// cancelled.
  std::vector<std::vector<Eigen::Vector2d>> OutlinesOf(const std::vector<CellBlock>& blocks,
                                                       const Eigen::Vector2i& num_cells,
                                                       const CancellationToken& cancellation) const;

 private:
  ClosestApproach Closest(const CellBlock& block) const;

  Eigen::Vector2d origin_;
  Eigen::Vector2d size_;
  const std::vector<GroundedStance>& goals_;
};

}  // namespace possibility::actions
