#include "actions/flood/blocks_from_above.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "actions/flood/cell_outline.h"

namespace possibility::actions {

using Eigen::Vector2d;
using Eigen::Vector2i;

ClosestApproach BlocksFromAbove::Closest(const CellBlock& block) const {
  const Vector2d low(block.x0, block.y0), high(block.x1 - 1, block.y1 - 1);
  ClosestApproach closest{.distance = std::numeric_limits<double>::infinity()};
  for (const GroundedStance& goal : goals_) {
    const Vector2d at = (goal.pose.position() - origin_).cwiseQuotient(size_);
    const Vector2d cell = at.array().floor().matrix().cwiseMax(low).cwiseMin(high);
    const Vector2d point = origin_ + size_.cwiseProduct(cell + Vector2d::Constant(0.5));
    const double distance = (goal.pose.position() - point).norm();
    if (distance >= closest.distance) continue;
    closest = {point, distance,
               CellBlock::Of(block.plane, static_cast<int>(cell.x()), static_cast<int>(cell.y()))};
  }
  return closest;
}

ClosestApproach BlocksFromAbove::ClosestOf(const std::deque<BlockFlood::Reached>& reached) const {
  ClosestApproach closest{.distance = std::numeric_limits<double>::infinity()};
  for (const BlockFlood::Reached& one : reached) {
    const ClosestApproach own = Closest(one.block);
    if (own.distance < closest.distance) closest = own;
  }
  return closest;
}

std::vector<std::vector<Vector2d>> BlocksFromAbove::OutlinesOf(
    const std::vector<CellBlock>& blocks, const Vector2i& num_cells,
    const CancellationToken& cancellation) const {
  CellMask mask(num_cells.x(), num_cells.y());
  for (const CellBlock& block : blocks) mask.Add(block.x0, block.y0, block.x1, block.y1);
  std::vector<std::vector<Vector2d>> outlines;
  for (const std::vector<Vector2i>& corners : mask.Outlines(cancellation)) {
    outlines.emplace_back();
    for (const Vector2i& corner : corners) {
      outlines.back().emplace_back(origin_ + size_.cwiseProduct(corner.cast<double>()));
    }
  }
  return outlines;
}

}  // namespace possibility::actions
