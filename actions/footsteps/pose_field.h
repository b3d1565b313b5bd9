#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <vector>

#include "actions/motion/planar_pose.h"
#include "common/cancellation_token.h"

namespace possibility::actions {

/// Times of the quickest ways to some goals among poses of a lattice in SE(2), by Dijkstra's
/// algorithm. A pose has ten neighbours: eight cells around it, and a turn to either side.
class PoseField {
 public:
  struct Paces {
    double ahead = 1;  ///< s/m, forwards or backwards
    double aside = 1;  ///< s/m
    double turn = 1;   ///< s/rad
  };
  static constexpr int kHeadings = 16;

  /// `bounds`, `cell`: m. `first_heading`: rad, one of the lattice's headings. `is_open`: of a pose
  /// of the lattice; asked once per pose, and only where a way leads. The poses nearest to goals
  /// are open. @throws Cancelled.
  PoseField(const Eigen::AlignedBox2d& bounds, double cell, double first_heading,
            const std::vector<PlanarPose>& goals, const Paces& paces,
            const std::function<bool(const PlanarPose&)>& is_open,
            const CancellationToken& cancellation = {});

  /// From the nearest pose of the lattice, s. Infinite if no way leads from there.
  double At(const PlanarPose& pose) const { return times_[IndexOf(pose)]; }

 private:
  std::size_t IndexOf(const PlanarPose& pose) const;
  std::size_t Index(int column, int row, int heading) const {
    return (static_cast<std::size_t>(row) * columns_ + column) * kHeadings + heading;
  }

  Eigen::AlignedBox2d bounds_;
  double cell_;
  double first_heading_;
  int columns_ = 1, rows_ = 1;
  std::vector<double> times_;
};

}  // namespace possibility::actions
