#include "actions/motion/smooth_under.h"

#include <algorithm>
#include <cmath>

namespace possibility::actions {
namespace {

/// Times an end of a support may miss a sample by rounding, in steps.
constexpr double kRounding = 1e-6;

}  // namespace

SmoothUnder::SmoothUnder(const Eigen::VectorXd& bound, double step, double spacing) {
  const auto last = bound.size() - 1;
  const double duration = static_cast<double>(last) * step;
  const int pieces = std::max(1, static_cast<int>(std::lround(duration / spacing)));
  spacing_ = duration / pieces;
  coefficients_.resize(pieces + 3);
  for (int j = 0; j < pieces + 3; ++j) {
    const double centre = (j - 1) * spacing_ / step;
    const double reach = 2 * spacing_ / step + kRounding;
    const auto clamped = [last](double sample) {
      return std::clamp<Eigen::Index>(static_cast<Eigen::Index>(sample), 0, last);
    };
    const Eigen::Index from = clamped(std::ceil(centre - reach));
    const Eigen::Index to = clamped(std::floor(centre + reach));
    coefficients_[j] = bound.segment(from, to - from + 1).minCoeff();
  }
}

ScalarSignal SmoothUnder::At(double t) const {
  const auto pieces = coefficients_.size() - 3;
  const double at = std::clamp(t / spacing_, 0.0, static_cast<double>(pieces));
  const Eigen::Index j = std::min(static_cast<Eigen::Index>(at), pieces - 1);
  const double s = at - static_cast<double>(j);
  const double r = 1 - s;
  const Eigen::Vector4d c = coefficients_.segment<4>(j);
  const Eigen::Vector4d value(r * r * r, 3 * s * s * s - 6 * s * s + 4,
                              3 * r * r * r - 6 * r * r + 4, s * s * s);
  const Eigen::Vector4d rate(-r * r, 3 * s * s - 4 * s, -3 * r * r + 4 * r, s * s);
  const Eigen::Vector4d acceleration(r, 3 * s - 2, 3 * r - 2, s);
  return {value.dot(c) / 6, rate.dot(c) / (2 * spacing_),
          acceleration.dot(c) / (spacing_ * spacing_)};
}

}  // namespace possibility::actions
