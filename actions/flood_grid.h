#pragma once

#include <Eigen/Core>
#include <functional>
#include <limits>
#include <set>
#include <vector>

#include "actions/cell_grid.h"
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
/// above; `expand(cell)`: offers the cell's neighbours; `barrier(cell)`: what closes the way on
/// from there.
template <typename Centre, typename Expand, typename Barrier>
FloodResult FloodGrid(CellGrid* grid, const CellGrid::Cell& start,
                      const std::set<CellGrid::Cell>& goal_cells,
                      const std::vector<GroundedStance>& goals,
                      const std::function<bool()>& keep_going, const Centre& centre,
                      const Expand& expand, const Barrier& barrier) {
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
  result.closest = closest.point();
  result.distance = closest.distance();
  result.cells = grid->tested();
  result.barrier = barrier(closest.cell());
  return result;
}

}  // namespace possibility::actions
