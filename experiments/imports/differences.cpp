#include "experiments/imports/differences.h"

#include <algorithm>

namespace possibility::experiments {

DifferenceWeights WeightsAt(double t, const std::vector<double>& times) {
  const auto n = static_cast<Eigen::Index>(times.size());
  Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(n, 3);  // of derivatives 0, 1, 2
  weights(0, 0) = 1;
  double c1 = 1;
  double c4 = times[0] - t;
  for (Eigen::Index i = 1; i < n; ++i) {
    const Eigen::Index order = std::min<Eigen::Index>(i, 2);
    double c2 = 1;
    const double c5 = c4;
    c4 = times[i] - t;
    for (Eigen::Index j = 0; j < i; ++j) {
      const double c3 = times[i] - times[j];
      c2 *= c3;
      if (j == i - 1) {
        for (Eigen::Index k = order; k > 0; --k) {
          weights(i, k) = c1 * (k * weights(i - 1, k - 1) - c5 * weights(i - 1, k)) / c2;
        }
        weights(i, 0) = -c1 * c5 * weights(i - 1, 0) / c2;
      }
      for (Eigen::Index k = order; k > 0; --k) {
        weights(j, k) = (c4 * weights(j, k) - k * weights(j, k - 1)) / c3;
      }
      weights(j, 0) = c4 * weights(j, 0) / c3;
    }
    c1 = c2;
  }
  return {weights.col(1), weights.col(2)};
}

}  // namespace possibility::experiments
