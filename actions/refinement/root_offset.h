#pragma once

#include <Eigen/Core>

#include "actions/plan/plan.h"

namespace possibility::actions {

using Vector6d = Eigen::Matrix<double, 6, 1>;

/// How the root differs from its course in a plan, over time: rows 0-2 rotation vector theta with
/// R = exp([theta]) R_plan, rows 3-5 displacement, world axes; and its first two derivatives.
struct RootOffset {
  Vector6d value = Vector6d::Zero();         ///< rad, m
  Vector6d rate = Vector6d::Zero();          ///< per s
  Vector6d acceleration = Vector6d::Zero();  ///< per s^2
};

/// The knot with its root moved: q, v and a.
Knot Moved(const Knot& knot, const RootOffset& offset);

/// The offset whose acceleration changes that of the moved root by `change` (angular, linear).
Vector6d OffsetAcceleration(const RootOffset& offset, const Vector6d& change);

/// The offset (value and rate) that moves the root of `plan` to that of `moved`.
RootOffset OffsetBetween(const Knot& plan, const Knot& moved);

/// The quintic that begins with value and rate of `begin` and acceleration 0 and has come to 0 with
/// its derivatives after `duration`, s, at the fraction `s` of it.
RootOffset Faded(const RootOffset& begin, double duration, double s);

}  // namespace possibility::actions
