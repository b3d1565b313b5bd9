#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace possibility::collocation {

/// How a motion is discretised over one mesh interval: its highest derivative is the polynomial
/// through its values at `nodes`, everything below follows by integrating that polynomial exactly
/// (docs/collocation.md). With nodes 0, 1 that is the trapezoidal rule, with 0, 1/2, 1
/// Hermite-Simpson; for order 2 it is their second-order form, where q' = v holds everywhere.
struct TranscriptionScheme {
  std::string name;
  std::vector<double> nodes;  ///< from 0 to 1, ascending; the ends are knots
  /// States at the nodes between the ends: variables with a row each ("separated"), or expressions
  /// in the interval's other variables ("compressed").
  bool separated = true;

  /// integral[k](i, j): the k-th repeated integral from 0 to node i of the j-th Lagrange
  /// polynomial; k = 0: one at node j; up to 2.
  std::vector<Eigen::MatrixXd> integral;
  /// Column j: the coefficients of the j-th Lagrange polynomial, lowest power first.
  Eigen::MatrixXd lagrange;

  /// Share of the interval's length that each node has in the integral of a function.
  Eigen::VectorXd weights() const { return integral[1].bottomRows<1>().transpose(); }
  int num_nodes() const { return static_cast<int>(nodes.size()); }
  /// The k-th repeated integrals from 0 to c of the Lagrange polynomials; k = 0: themselves.
  Eigen::VectorXd LagrangeIntegrals(double c, int k) const;
};

TranscriptionScheme Trapezoidal();
TranscriptionScheme HermiteSimpson();  ///< separated
TranscriptionScheme CompressedHermiteSimpson();
/// Any nodes from 0 to 1. @throws std::invalid_argument unless they ascend from 0 to 1.
TranscriptionScheme SchemeOfNodes(const std::string& name, const std::vector<double>& nodes,
                                  bool separated);

}  // namespace possibility::collocation
