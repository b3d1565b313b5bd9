#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <vector>

#include "actions/gait_motion.h"
#include "actions/motion_builder.h"
#include "actions/transition_motion.h"
#include "models/robot_model.h"

namespace possibility::actions {

/// Boxes in a stance frame, one per slab of height, that hold every link of the robot during the
/// motions they were computed from. They start `kGroundGap` above the ground, which the soles
/// touch.
class SweptVolume {
 public:
  /// Added on every side: motions are sampled in time and displacement, the robot moves on between
  /// the samples. The property tests of C_S hold this figure to account.
  static constexpr double kSamplingMargin = 0.005;
  static constexpr double kGroundGap = 0.001;
  static constexpr double kSlabHeight = 0.1;

  /// Adds the links at the poses `X_WL`, seen from `frame` on ground of height 0.
  void Add(const models::RobotModel& robot, const std::vector<Eigen::Isometry3d>& X_WL,
           const PlanarPose& frame);

  /// Merges neighbouring slabs where that adds little volume, and adds the sampling margin.
  std::vector<Eigen::AlignedBox3d> Boxes() const;

 private:
  std::vector<Eigen::AlignedBox3d> slabs_;
};

/// Volume swept by every stride that the gait's bounds allow, in StrideFrame.
/// @throws InputError naming the stride if the robot cannot execute one of the bounds' extremes
///   within its limits, without colliding with itself; Abandoned if `keep_going` (may be empty)
///   says no.
SweptVolume SweepGait(const models::RobotModel& robot, const NominalStance& stance,
                      const std::function<bool()>& keep_going = {});

/// Volume swept by a transition, in the first gait's stance frame.
SweptVolume SweepTransition(const models::RobotModel& robot, const TransitionMotion& transition);

}  // namespace possibility::actions
