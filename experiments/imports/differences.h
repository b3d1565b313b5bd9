#pragma once

#include <Eigen/Core>
#include <vector>

namespace possibility::experiments {

/// Weights of samples in the first and second derivative at `t` of the polynomial through them.
/// Fornberg 1988, Generation of Finite Difference Formulas on Arbitrarily Spaced Grids, Mathematics
/// of Computation 51, 699-706.
struct DifferenceWeights {
  Eigen::VectorXd first;
  Eigen::VectorXd second;
};

/// `times`: distinct, s; at least two.
DifferenceWeights WeightsAt(double t, const std::vector<double>& times);

}  // namespace possibility::experiments
