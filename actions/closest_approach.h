#pragma once

#include <Eigen/Core>
#include <limits>
#include <vector>

#include "actions/cell_grid.h"
#include "actions/locomotion_model.h"

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

}  // namespace possibility::actions
