#pragma once

#include <Eigen/Core>

#include "actions/wholebody/signal.h"

namespace possibility::actions {

/// Motion of a centre of mass in one direction by the linear inverted pendulum: a cubic spline c
/// with c'' = w (c - p) at every knot, hence C2. The ends of c are given and at rest.
/// docs/gaits.md derives it.
class PendulumSpline {
 public:
  /// `times`: of the knots, N + 1 >= 3 increasing values from 0 on, s. `zmp`: p at the knots, m.
  /// `from`, `to`: c at the ends, m. `stiffness`: w = g / height of the centre of mass, 1/s^2. p is
  /// changed where `first` and `last` (N + 1 values each) are not 0, by a multiple of each, so that
  /// the ends are at rest.
  PendulumSpline(const Eigen::VectorXd& times, const Eigen::VectorXd& zmp, double from, double to,
                 double stiffness, const Eigen::VectorXd& first, const Eigen::VectorXd& last);

  /// c, c' and c'' at time t in [0, times[N]].
  ScalarSignal At(double t) const;

  /// c - c'' / w at knot i: the zero moment point of the pendulum, m.
  double Zmp(int i) const { return value_[i] - curvature_[i] / stiffness_; }

 private:
  Eigen::VectorXd times_;
  double stiffness_;
  Eigen::VectorXd value_;      ///< c at the knots
  Eigen::VectorXd curvature_;  ///< c'' at the knots
};

}  // namespace possibility::actions
