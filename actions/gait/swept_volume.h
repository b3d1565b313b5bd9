#pragma once

#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "actions/gait/gait_motion.h"
#include "actions/gait/stride.h"
#include "actions/wholebody/motion_builder.h"
#include "common/cancellation_token.h"
#include "models/robot/robot_model.h"

namespace possibility::actions {

/// Boxes in a stance frame, one per slab of height, that contain every link of the robot during the
/// sampled motions. They start `kGroundGap` above the ground because the soles touch it.
class SweptVolume {
 public:
  /// Added on every side: motions are sampled in time, displacement and duration, and the robot
  /// moves between samples. The property tests of C_S check this figure.
  static constexpr double kSamplingMargin = 0.008;
  /// The same for a posture, which is static.
  static constexpr double kStandingMargin = 0.002;
  static constexpr double kGroundGap = 0.001;
  static constexpr double kSlabHeight = 0.1;

  /// Adds the links at the poses `X_WL` on ground of height 0. Each shape counts in that of
  /// `frames` (at least one) where it is closest to its pose in the nominal posture, `nominal_X_FL`
  /// (unused if there is one frame): C_S tests the volume in all frames of a way.
  void Add(const models::RobotModel& robot, const std::vector<Eigen::Isometry3d>& X_WL,
           const std::vector<PlanarPose>& frames,
           const std::vector<Eigen::Isometry3d>& nominal_X_FL);
  void Add(const SweptVolume& other);

  /// Merges neighbouring slabs where that adds little volume, and adds the sampling margin.
  std::vector<Eigen::AlignedBox3d> Boxes() const;

  /// One list of boxes per volume, with `margins[i]` (m) on every side of volume i. Neighbouring
  /// slabs are merged in all volumes or in none: if a volume lies inside another, so do its boxes.
  static std::vector<std::vector<Eigen::AlignedBox3d>> BoxesOf(
      const std::vector<SweptVolume>& volumes, const std::vector<double>& margins);

 private:
  void Add(const Eigen::AlignedBox3d& bounds);
  Eigen::AlignedBox3d Grown(std::size_t slab, double margin) const;

  std::vector<Eigen::AlignedBox3d> slabs_;
};

/// Swept volumes of a gait.
struct GaitVolumes {
  /// The nominal posture, in the stance frame.
  std::vector<Eigen::AlignedBox3d> standing;
  /// By class: volume of all strides of the class within the bounds, in StrideFrame. Each contains
  /// `standing` displaced by up to half such a stride without a turn.
  std::array<std::vector<Eigen::AlignedBox3d>, kStrideClasses.size()> sweeps;

  const std::vector<Eigen::AlignedBox3d>& sweep(StrideClass strides) const {
    return sweeps[static_cast<std::size_t>(strides)];
  }
};

/// `motion`: of the gait that `stance` belongs to. The result does not depend on `threads`,
/// all of which ask `cancellation`.
/// @throws InputError naming the stride if the robot cannot execute an extreme stride of the bounds
/// within its limits and without self-collision; Cancelled.
GaitVolumes SweepGait(const models::RobotModel& robot, const NominalStance& stance,
                      const GaitMotion& motion, const CancellationToken& cancellation = {},
                      int threads = 1);

}  // namespace possibility::actions
