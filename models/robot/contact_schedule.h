#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

namespace possibility::models {

/// A stretch of time in which the same contacts bear.
struct ContactInterval {
  double duration = 0;  ///< s
  /// By contact: pose in the world of its points as a patch (models::ContactPatch::Frame), or none
  /// while it does not bear. Fewer than three points do not hold their orientation: then it gives
  /// only the limb's heading.
  std::vector<std::optional<Eigen::Isometry3d>> bearing;
};

/// Which contact bears where, and when. A contact that swings goes from where it bore last to where
/// it bears next.
struct ContactSchedule {
  std::vector<std::string>
      contacts;  ///< names as in RobotModel::contacts, or parts of patches as in a plan, each once
  std::vector<ContactInterval> intervals;

  double duration() const;  ///< s

  /// Pose where `contact` bore last before interval `k`, or bears in it. It must have borne.
  const Eigen::Isometry3d& Before(int k, int contact) const;
  /// Pose where `contact` bears next after interval `k`, or bears in it. It must bear again.
  const Eigen::Isometry3d& After(int k, int contact) const;
};

/// @throws std::invalid_argument unless there is an interval and a contact, durations are positive
/// and finite, each interval has one entry per contact, and contacts stay where they bear.
void CheckContactSchedule(const ContactSchedule& schedule);

}  // namespace possibility::models
