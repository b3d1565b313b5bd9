#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace possibility::dynamics {

/// Derivative at 0 of a vector function of one number: central differences at steps h, h/2, h/4,
/// extrapolated twice (Richardson), so that the error is of order h^6.
template <typename Function>
Eigen::VectorXd RichardsonDerivative(const Function& f, double h = 0.02) {
  const auto central = [&](double step) -> Eigen::VectorXd {
    const Eigen::VectorXd ahead = f(step);
    return (ahead - f(-step)) / (2 * step);
  };
  const Eigen::VectorXd coarse = central(h);
  const Eigen::VectorXd middle = central(h / 2);
  const Eigen::VectorXd fine = central(h / 4);
  const Eigen::VectorXd first = (4 * middle - coarse) / 3;
  const Eigen::VectorXd second = (4 * fine - middle) / 3;
  return (16 * second - first) / 15;
}

/// The matrix whose column i is the derivative of f(t * e_i).
template <typename Function>
Eigen::MatrixXd RichardsonJacobian(const Function& f, int columns, double h = 0.02) {
  Eigen::MatrixXd J;
  for (int i = 0; i < columns; ++i) {
    const Eigen::VectorXd column = RichardsonDerivative(
        [&](double t) -> Eigen::VectorXd { return f(t * Eigen::VectorXd::Unit(columns, i)); }, h);
    if (i == 0) J.resize(column.size(), columns);
    J.col(i) = column;
  }
  return J;
}

/// Greatest difference, relative to the expected matrix's greatest element.
inline double RelativeError(const Eigen::MatrixXd& actual, const Eigen::MatrixXd& expected) {
  if (actual.rows() != expected.rows() || actual.cols() != expected.cols()) return INFINITY;
  const double scale = std::max(1e-6, expected.cwiseAbs().maxCoeff());
  return (actual - expected).cwiseAbs().maxCoeff() / scale;
}

}  // namespace possibility::dynamics
