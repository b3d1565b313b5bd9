#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

namespace possibility::actions {

/// A stretch of time in which the same limbs bear.
struct ContactInterval {
  double duration = 0;  ///< s
  /// By limb: pose of its contact patch in the world, with the origin at the patch's centre, z
  /// along the ground's normal and x along the limb's heading. None while the limb swings.
  std::vector<std::optional<Eigen::Isometry3d>> bearing;
};

/// Which limb bears where, and when. A limb that swings goes from where it bore last to where it
/// bears next. All limbs bear in the first and the last interval.
struct ContactSchedule {
  std::vector<ContactInterval> intervals;

  double duration() const;  ///< s

  /// Pose where `limb` bore last before interval `k`, or bears in it.
  const Eigen::Isometry3d& Before(int k, int limb) const;
  /// Pose where `limb` bears next after interval `k`, or bears in it.
  const Eigen::Isometry3d& After(int k, int limb) const;
};

/// @throws std::invalid_argument unless the schedule is as described above: at least two intervals,
/// one entry per limb in each, at least one limb, positive durations, limbs that stay where they
/// bear.
void CheckContactSchedule(const ContactSchedule& schedule);

}  // namespace possibility::actions
