#pragma once

#include <Eigen/Core>

#include "actions/wholebody/signal.h"

namespace possibility::actions {

/// Motion of a centre of mass in one direction by the linear inverted pendulum: a cubic spline c
/// over N + 1 equal steps with c'' = w (c - p) at every knot, hence C2. The ends of c are given and
/// at rest. docs/gaits.md derives it.
class PendulumSpline {
 public:
  /// `zmp`: p at the knots, N + 1 >= 3 values, m. `from`, `to`: c at the ends, m. `step`: s.
  /// `stiffness`: w = g / height of the centre of mass, 1/s^2. p is changed where `first` and
  /// `last` (N + 1 values each) are not 0, by a multiple of each, so that the ends are at rest.
  PendulumSpline(const Eigen::VectorXd& zmp, double from, double to, double step, double stiffness,
                 const Eigen::VectorXd& first, const Eigen::VectorXd& last);

  /// c, c' and c'' at time t in [0, N step].
  ScalarSignal At(double t) const;

  /// c - c'' / w at knot i: the zero moment point of the pendulum, m.
  double Zmp(int i) const { return value_[i] - curvature_[i] / stiffness_; }

 private:
  double step_;
  double stiffness_;
  Eigen::VectorXd value_;      ///< c at the knots
  Eigen::VectorXd curvature_;  ///< c'' at the knots
};

}  // namespace possibility::actions
