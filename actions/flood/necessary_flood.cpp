#include "actions/flood/necessary_flood.h"

#include <algorithm>
#include <set>
#include <string>
#include <utility>

#include "actions/flood/block_flood.h"
#include "actions/flood/blocks_from_above.h"

namespace possibility::actions {
namespace {

/// Upper bound of the distance from the root to a bearing point, in any gait.
double FarthestBearing(const LocomotionModel& model) {
  double reach = 0;
  for (const auto& gait : model.gaits) {
    reach = std::max(reach, BearingReach(*model.robot, *gait->stance.gait));
  }
  return reach;
}

FlightBounds FarthestFlight(const std::vector<FlightBounds>& flights) {
  FlightBounds farthest;
  for (const FlightBounds& flight : flights) {
    farthest.rise = std::max(farthest.rise, flight.rise);
    farthest.range = std::max(farthest.range, flight.range);
  }
  return farthest;
}

void OfferNeighbours(const CellBlock& block, BlockFlood* flood) {
  flood->Offer({block.plane, block.x0 - 1, block.y0, block.x0, block.y1});
  flood->Offer({block.plane, block.x1, block.y0, block.x1 + 1, block.y1});
  flood->Offer({block.plane, block.x0, block.y0 - 1, block.x1, block.y0});
  flood->Offer({block.plane, block.x0, block.y1, block.x1, block.y1 + 1});
  for (const int step : {-1, 1}) {
    CellBlock next = block;
    next.plane += step;
    flood->Offer(next);
  }
}

Barrier BarrierOf(const PelvisCells& cells, const BlocksFromAbove& view, const BlockFlood& flood,
                  double z, const std::vector<GroundedStance>& goals,
                  const CancellationToken& cancellation) {
  const ClosestApproach closest = view.ClosestOf(flood.reached());
  std::set<std::string> closed_by;
  for (const GroundedStance& goal : goals) {
    for (std::string& name : cells.Blockers(closest.cell, goal)) closed_by.insert(std::move(name));
  }
  std::vector<CellBlock> blocks;
  for (const BlockFlood::Reached& reached : flood.reached()) blocks.push_back(reached.block);
  const Eigen::Vector2i size = cells.num_cells().head<2>().cast<int>();
  Barrier barrier;
  barrier.closest = closest.point;
  barrier.distance = closest.distance;
  barrier.closed_by = {closed_by.begin(), closed_by.end()};
  barrier.reached.push_back({"", z, view.OutlinesOf(blocks, size, cancellation)});
  return barrier;
}

}  // namespace

PelvisCells PelvisCellsOf(const LocomotionModel& model, const World& world, double resolution,
                          const std::vector<FlightBounds>& flights) {
  return PelvisCells(model, world, resolution, FarthestBearing(model), FarthestFlight(flights));
}

std::optional<std::vector<CellBlock>> ReachedCells(const PelvisCells& cells,
                                                   const GroundedStance& start,
                                                   const FloodLimits& limits) {
  if (!(cells.num_cells().z() <= CellQuadtrees::kMostAlong)) return std::nullopt;
  BlockFlood flood(
      static_cast<int>(cells.num_cells().z()), cells.num_cells().x(), cells.num_cells().y(),
      [&](const CellBlock& block) { return cells.Judge(block); }, limits);
  const FloodEnd end = flood.Run(
      cells.CellOf(start), [](const CellBlock&) { return false; },
      [](const CellBlock&) { return 0.0; },
      [&](const CellBlock& block) { OfferNeighbours(block, &flood); }, [](const CellBlock&) {});
  if (end == FloodEnd::kCutShort) return std::nullopt;
  std::vector<CellBlock> blocks;
  for (const BlockFlood::Reached& reached : flood.reached()) blocks.push_back(reached.block);
  return blocks;
}

FloodResult FloodNecessary(const LocomotionModel& model, const World& world,
                           const GroundedStance& start, const std::vector<GroundedStance>& goals,
                           double resolution, const FloodLimits& limits,
                           const std::vector<FlightBounds>& flights) {
  const PelvisCells cells = PelvisCellsOf(model, world, resolution, flights);
  FloodResult result;
  result.is_cut_short = true;
  if (!(cells.num_cells().z() <= CellQuadtrees::kMostAlong)) return result;
  BlockFlood flood(
      static_cast<int>(cells.num_cells().z()), cells.num_cells().x(), cells.num_cells().y(),
      [&](const CellBlock& block) { return cells.Judge(block); }, limits);
  std::vector<CellBlock> goal_cells;
  for (const GroundedStance& goal : goals) goal_cells.push_back(cells.CellOf(goal));
  const BlocksFromAbove view(cells.origin().head<2>(), cells.size().head<2>(), goals);
  const FloodEnd end = flood.Run(
      cells.CellOf(start),
      [&](const CellBlock& block) {
        return std::any_of(goal_cells.begin(), goal_cells.end(),
                           [&](const CellBlock& cell) { return block.Contains(cell); });
      },
      [&](const CellBlock& block) { return view.Distance(block); },
      [&](const CellBlock& block) { OfferNeighbours(block, &flood); }, [](const CellBlock&) {});
  result.cells = flood.judged();
  result.is_cut_short = end == FloodEnd::kCutShort;
  result.route_may_exist = end != FloodEnd::kNothingLeft;
  if (end == FloodEnd::kNothingLeft) {
    result.barrier = BarrierOf(cells, view, flood, start.z, goals, limits.cancellation);
  }
  return result;
}

}  // namespace possibility::actions
