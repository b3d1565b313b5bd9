#pragma once

#include <Eigen/Core>

#include "actions/wholebody/signal.h"

namespace possibility::actions {

/// The way of a limb's patch from one place to the next, from rest to rest.
struct SwingPath {
  Eigen::Vector3d from = Eigen::Vector3d::Zero();  ///< m
  Eigen::Vector3d to = Eigen::Vector3d::Zero();    ///< m
  double clearance = 0;  ///< m, in the middle, above the line between the ends
  /// m: if above 0, or if the ends differ in height, the patch goes up, across and down, and
  /// crosses this high above the higher end (at least `clearance`).
  double lift = 0;
  double duration = 1;  ///< s
  /// The ends bear on one slope: without a lift, the patch stays above the line that joins them.
  bool on_slope = false;
  double evenness = 1;  ///< of the speed across (EvenRestToRest), unless the swing is high

  bool IsHigh() const { return lift > 0 || (from.z() != to.z() && !on_slope); }
  /// `t`: s since the start.
  Signal<Eigen::Vector3d> At(double t) const;
  /// Share of the horizontal way, from 0 to 1.
  ScalarSignal Progress(double t) const;
};

}  // namespace possibility::actions
