#include "actions/motion/pendulum_spline.h"

#include <algorithm>
#include <cmath>

namespace possibility::actions {
namespace {

using Eigen::VectorXd;

/// The spline of one zero moment point: c at the knots, with given ends.
class Spline {
 public:
  /// `steps`: from knot to knot, s.
  Spline(const VectorXd& steps, const VectorXd& zmp, double from, double to, double stiffness)
      : steps_(steps), value_(zmp.size()), curvature_(zmp.size()) {
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
    const Eigen::Index n = steps_.size();
    const double first = steps_[0];
    const double last = steps_[n - 1];
    return {
        (value_[1] - value_[0]) / first - first / 6 * (2 * curvature_[0] + curvature_[1]),
        (value_[n] - value_[n - 1]) / last + last / 6 * (curvature_[n - 1] + 2 * curvature_[n])};
  }

 private:
  /// c' is continuous at every inner knot: a tridiagonal system, solved by Thomas's algorithm (the
  /// matrix is diagonally dominant).
  void SolveInterior(const VectorXd& p, double stiffness) {
    const Eigen::Index n = steps_.size();
    const double sixth = stiffness / 6;
    VectorXd upper(n), right(n);
    upper[0] = 0;
    right[0] = value_[0];
    for (Eigen::Index i = 1; i < n; ++i) {
      const double h = steps_[i - 1];
      const double g = steps_[i];
      const double before = 1 / h - sixth * h;
      const double after = 1 / g - sixth * g;
      const double middle = -(1 / h + 1 / g + 2 * sixth * (h + g));
      const double load = -sixth * (h * p[i - 1] + 2 * (h + g) * p[i] + g * p[i + 1]);
      const double pivot = middle - before * upper[i - 1];
      upper[i] = after / pivot;
      right[i] = (load - before * right[i - 1]) / pivot;
    }
    for (Eigen::Index i = n - 1; i >= 1; --i) value_[i] = right[i] - upper[i] * value_[i + 1];
  }

  const VectorXd& steps_;
  VectorXd value_, curvature_;
};

}  // namespace

PendulumSpline::PendulumSpline(const VectorXd& times, const VectorXd& zmp, double from, double to,
                               double stiffness, const VectorXd& first, const VectorXd& last)
    : times_(times), stiffness_(stiffness) {
  const Eigen::Index n = times.size() - 1;
  const VectorXd steps = times.tail(n) - times.head(n);
  const Spline spline(steps, zmp, from, to, stiffness);
  const Spline by_first(steps, first, 0, 0, stiffness);
  const Spline by_last(steps, last, 0, 0, stiffness);
  Eigen::Matrix2d rates;
  rates << by_first.EndRates(), by_last.EndRates();
  const Eigen::Vector2d share = -rates.inverse() * spline.EndRates();
  value_ = spline.value() + share[0] * by_first.value() + share[1] * by_last.value();
  curvature_ =
      spline.curvature() + share[0] * by_first.curvature() + share[1] * by_last.curvature();
}

ScalarSignal PendulumSpline::At(double t) const {
  const double* inner = times_.data() + 1;
  const Eigen::Index i = std::upper_bound(inner, inner + times_.size() - 2, t) - inner;
  const double step = times_[i + 1] - times_[i];
  const double b = (t - times_[i]) / step;
  const double a = 1 - b;
  const double h2 = step * step / 6;
  return {a * value_[i] + b * value_[i + 1] +
              h2 * ((a * a * a - a) * curvature_[i] + (b * b * b - b) * curvature_[i + 1]),
          (value_[i + 1] - value_[i]) / step +
              step / 6 * ((1 - 3 * a * a) * curvature_[i] + (3 * b * b - 1) * curvature_[i + 1]),
          a * curvature_[i] + b * curvature_[i + 1]};
}

}  // namespace possibility::actions
