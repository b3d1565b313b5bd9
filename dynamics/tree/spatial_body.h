#pragma once

#include <Eigen/Core>

#include "dynamics/tree/spatial.h"

namespace possibility::dynamics {

/// A link in motion, or the links of a subtree together. Spatial vectors about the root's origin,
/// world axes, in the frame that moves with that origin (no derivative depends on its motion).
struct SpatialBody {
  double mass = 0;
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();    ///< mass * com
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();   ///< rotational, about the origin
  Eigen::Vector3d momentum = Eigen::Vector3d::Zero();  ///< linear
  Eigen::Matrix3d coriolis = Eigen::Matrix3d::Zero();  ///< D of docs/dynamics.md
  SpatialVector force;

  /// I x.
  SpatialVector Inertia(const SpatialVector& x) const {
    return {Times(inertia, x.angular) + Cross(moment, x.linear),
            mass * x.linear - Cross(moment, x.angular)};
  }
  /// B x.
  SpatialVector Coriolis(const SpatialVector& x) const {
    return {Times(coriolis, x.angular), Cross(x.angular, momentum)};
  }
  /// Angular part of B' x; the linear part is zero.
  Eigen::Vector3d CoriolisTransposed(const SpatialVector& x) const {
    return TransposedTimes(coriolis, x.angular) + Cross(momentum, x.linear);
  }
  /// Its moment is the axial vector of D.
  SpatialVector Momentum() const {
    return {{coriolis(1, 2) - coriolis(2, 1), coriolis(2, 0) - coriolis(0, 2),
             coriolis(0, 1) - coriolis(1, 0)},
            momentum};
  }
};

}  // namespace possibility::dynamics
