#include "actions/motion/pendulum_spline.h"

#include <algorithm>
#include <cmath>

namespace possibility::actions {
namespace {

using Eigen::VectorXd;

/// The spline of one zero moment point: c at the knots, with given ends.
class Spline {
 public:
  Spline(const VectorXd& zmp, double from, double to, double step, double stiffness)
      : step_(step), value_(zmp.size()), curvature_(zmp.size()) {
    const Eigen::Index last = zmp.size() - 1;
    value_[0] = from;
    value_[last] = to;
    SolveInterior(zmp, stiffness);
    curvature_ = stiffness * (value_ - zmp);
  }

  const VectorXd& value() const { return value_; }
  const VectorXd& curvature() const { return curvature_; }

  /// c' at both ends.
  Eigen::Vector2d EndRates() const {
    const Eigen::Index n = value_.size() - 1;
    return {
        (value_[1] - value_[0]) / step_ - step_ / 6 * (2 * curvature_[0] + curvature_[1]),
        (value_[n] - value_[n - 1]) / step_ + step_ / 6 * (curvature_[n - 1] + 2 * curvature_[n])};
  }

 private:
  /// c' is continuous at every inner knot: a tridiagonal system, solved by Thomas's algorithm (the
  /// matrix is diagonally dominant).
  void SolveInterior(const VectorXd& p, double stiffness) {
    const Eigen::Index n = value_.size() - 1;
    const double k = step_ * step_ * stiffness / 6;
    const double side = 1 - k;
    const double middle = -(2 + 4 * k);
    VectorXd upper(n), right(n);
    upper[0] = 0;
    right[0] = value_[0];
    for (Eigen::Index i = 1; i < n; ++i) {
      const double pivot = middle - side * upper[i - 1];
      upper[i] = side / pivot;
      right[i] = (-k * (p[i - 1] + 4 * p[i] + p[i + 1]) - side * right[i - 1]) / pivot;
    }
    for (Eigen::Index i = n - 1; i >= 1; --i) value_[i] = right[i] - upper[i] * value_[i + 1];
  }

  double step_;
  VectorXd value_, curvature_;
};

}  // namespace

PendulumSpline::PendulumSpline(const VectorXd& zmp, double from, double to, double step,
                               double stiffness, const VectorXd& first, const VectorXd& last)
    : step_(step), stiffness_(stiffness) {
  const Spline spline(zmp, from, to, step, stiffness);
  const Spline by_first(first, 0, 0, step, stiffness);
  const Spline by_last(last, 0, 0, step, stiffness);
  Eigen::Matrix2d rates;
  rates << by_first.EndRates(), by_last.EndRates();
  const Eigen::Vector2d share = -rates.inverse() * spline.EndRates();
  value_ = spline.value() + share[0] * by_first.value() + share[1] * by_last.value();
  curvature_ =
      spline.curvature() + share[0] * by_first.curvature() + share[1] * by_last.curvature();
}

ScalarSignal PendulumSpline::At(double t) const {
  const Eigen::Index intervals = value_.size() - 1;
  const auto i =
      std::clamp<Eigen::Index>(static_cast<Eigen::Index>(std::floor(t / step_)), 0, intervals - 1);
  const double b = t / step_ - static_cast<double>(i);
  const double a = 1 - b;
  const double h2 = step_ * step_ / 6;
  return {a * value_[i] + b * value_[i + 1] +
              h2 * ((a * a * a - a) * curvature_[i] + (b * b * b - b) * curvature_[i + 1]),
          (value_[i + 1] - value_[i]) / step_ +
              step_ / 6 * ((1 - 3 * a * a) * curvature_[i] + (3 * b * b - 1) * curvature_[i + 1]),
          a * curvature_[i] + b * curvature_[i + 1]};
}

}  // namespace possibility::actions
