#include "actions/motion/smooth_under.h"

#include <algorithm>
#include <cmath>

namespace possibility::actions {
namespace {

/// By so much an end of a support may miss a sample, as a share of the support's spacing: rounding.
constexpr double kRounding = 1e-9;

}  // namespace

SmoothUnder::SmoothUnder(const Eigen::VectorXd& times, const Eigen::VectorXd& bound,
                         double spacing) {
  const double duration = times[times.size() - 1];
  const int pieces = std::max(1, static_cast<int>(std::lround(duration / spacing)));
  spacing_ = duration / pieces;
  coefficients_.resize(pieces + 3);
  for (int j = 0; j < pieces + 3; ++j) {
    const double centre = (j - 1) * spacing_;
    const double reach = (2 + kRounding) * spacing_;
    const double* begin = times.data();
    const double* end = begin + times.size();
    const Eigen::Index from = std::lower_bound(begin, end, centre - reach) - begin;
    const Eigen::Index to = std::upper_bound(begin, end, centre + reach) - begin;
    coefficients_[j] = bound.segment(from, to - from).minCoeff();
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
