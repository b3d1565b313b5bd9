#pragma once

#include <Eigen/Core>
#include <functional>
#include <limits>
#include <set>
#include <vector>

#include "actions/cell_grid.h"
#include "actions/cell_outline.h"
#include "actions/locomotion_model.h"
#include "actions/route_flood.h"

namespace possibility::actions {

/// Keeps the point of the flood that is closest to any goal.
class ClosestApproach {
 public:
  explicit ClosestApproach(const std::vector<GroundedStance>& goals) {
    for (const GroundedStance& goal : goals) goals_.push_back(goal.pose.position());
  }
  void Add(const Eigen::Vector2d& p, const CellGrid::Cell& cell) {
    for (const Eigen::Vector2d& goal : goals_) {
      const double distance = (goal - p).norm();
      if (distance < distance_) {
        distance_ = distance;
        point_ = p;
        cell_ = cell;
      }
    }
  }
  double distance() const { return distance_; }
  const Eigen::Vector2d& point() const { return point_; }
  const CellGrid::Cell& cell() const { return cell_; }

 private:
  std::vector<Eigen::Vector2d> goals_;
  double distance_ = std::numeric_limits<double>::infinity();
  Eigen::Vector2d point_ = Eigen::Vector2d::Zero();
  CellGrid::Cell cell_{};
};

/// Floods `grid` from `start` until it reaches one of `goal_cells`. `centre(cell)`: seen from
/// above; `expand(cell)`: offers the cell's neighbours; `closed_by(cell)`: what closes the way on
/// from there; `reached()`: the cells reached, as regions.
template <typename Centre, typename Expand, typename ClosedBy, typename Reached>
FloodResult FloodGrid(CellGrid* grid, const CellGrid::Cell& start,
                      const std::set<CellGrid::Cell>& goal_cells,
                      const std::vector<GroundedStance>& goals,
                      const std::function<bool()>& keep_going, const Centre& centre,
                      const Expand& expand, const ClosedBy& closed_by, const Reached& reached) {
  FloodResult result;
  ClosestApproach closest(goals);
  grid->Seed(start);
  while (!grid->Empty()) {
    if (keep_going && !keep_going()) return result;
    const CellGrid::Cell cell = grid->Pop();
    if (goal_cells.count(cell)) return result;
    closest.Add(centre(cell), cell);
    expand(cell);
  }
  result.route_may_exist = false;
  result.cells = grid->tested();
  result.barrier = {closest.point(), closest.distance(), closed_by(closest.cell()), reached()};
  return result;
}

/// The outlines of `mask` in the world: its cells are of `size` (m), the first begins at `origin`.
inline std::vector<std::vector<Eigen::Vector2d>> OutlinesOf(const CellMask& mask,
                                                            const Eigen::Vector2d& origin,
                                                            const Eigen::Vector2d& size) {
  std::vector<std::vector<Eigen::Vector2d>> outlines;
  for (const std::vector<Eigen::Vector2i>& corners : mask.Outlines()) {
    outlines.emplace_back();
    for (const Eigen::Vector2i& corner : corners) {
      outlines.back().emplace_back(origin + size.cwiseProduct(corner.cast<double>()));
    }
  }
  return outlines;
}

}  // namespace possibility::actions
