#pragma once

#include <Eigen/Core>

#include "actions/wholebody/signal.h"

namespace possibility::actions {

/// A twice continuously differentiable curve that lies nowhere above a sampled bound: the uniform
/// cubic B-spline whose coefficients are the least of the bound over their supports. Its values are
/// averages of coefficients (the convex-hull property, de Boor 1978), each of which keeps the
/// bound. Where the bound is least at an end, for the first four spacings, the curve rests there.
class SmoothUnder {
 public:
  SmoothUnder() = default;
  /// `bound`: at `times`, which increase from 0 on by less than `spacing`, s; at least two.
  /// `spacing`: s, of the coefficients, about.
  SmoothUnder(const Eigen::VectorXd& times, const Eigen::VectorXd& bound, double spacing);

  ScalarSignal At(double t) const;

 private:
  double spacing_ = 1;
  Eigen::VectorXd coefficients_;  ///< the first at -spacing
};

}  // namespace possibility::actions
