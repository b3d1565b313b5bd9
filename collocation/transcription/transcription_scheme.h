#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace possibility::collocation {

/// The discretisation of a motion over one mesh interval. Its highest derivative is the polynomial
/// through the values at `nodes`; all lower derivatives follow by exact integration of that
/// polynomial (docs/collocation.md). Nodes 0, 1 give the trapezoidal rule, nodes 0, 1/2, 1
/// Hermite-Simpson. For order 2 these are their second-order forms, where q' = v holds everywhere.
struct TranscriptionScheme {
  std::string name;
  std::vector<double> nodes;  ///< from 0 to 1, ascending; the ends are knots
  /// Whether the highest derivative has a value at the first and at the last node. Without one, it
  /// jumps at knots, and so do controls: constraints hold at the other nodes.
  bool value_at_start = true, value_at_end = true;
  /// States at the inner nodes: variables with a row each ("separated"), or expressions in the
  /// interval's other variables ("compressed").
  bool separated = true;

  /// integral[k](i, j): the k-th repeated integral from 0 to node i of the j-th Lagrange
  /// polynomial, k up to 2. For k = 0 the polynomial itself: 1 at node j.
  std::vector<Eigen::MatrixXd> integral;
  /// Column j: the coefficients of the j-th Lagrange polynomial, lowest power first; zero for a
  /// node without a value.
  Eigen::MatrixXd lagrange;

  /// Weight of each node in the integral of a function, as a share of the interval's length.
  Eigen::VectorXd weights() const { return integral[1].bottomRows<1>().transpose(); }
  int num_nodes() const { return static_cast<int>(nodes.size()); }
  bool HasValue(int node) const {
    return (node > 0 || value_at_start) && (node + 1 < num_nodes() || value_at_end);
  }
  bool IsClosed() const { return value_at_start && value_at_end; }
  /// Of convergence, if the nodes are those of Gauss, Radau or Lobatto.
  int order() const {
    return 2 * num_nodes() - 2 - (value_at_start ? 0 : 1) - (value_at_end ? 0 : 1);
  }
  /// The k-th repeated integrals from 0 to c of the Lagrange polynomials; k = 0: the polynomials.
  Eigen::VectorXd LagrangeIntegrals(double c, int k) const;
  /// The derivatives by c of the Lagrange polynomials.
  Eigen::VectorXd LagrangeSlopes(double c) const;
};

TranscriptionScheme Trapezoidal();
TranscriptionScheme HermiteSimpson();  ///< separated
TranscriptionScheme CompressedHermiteSimpson();
/// Gauss and Lobatto's nodes: among all with knots at both ends, those of the highest order, 2
/// nodes - 2; 2 and 3 nodes are the schemes above. `nodes`: 2 or more.
/// @throws std::invalid_argument for fewer.
TranscriptionScheme GaussLobatto(int nodes);
/// Gauss and Legendre's nodes: none at a knot, order 2 nodes. The states at knots follow by
/// integration. `nodes`: 1 or more. @throws std::invalid_argument for fewer.
TranscriptionScheme LegendreGauss(int nodes);
/// Radau's nodes, the last one at the end of the interval ("flipped"): order 2 nodes - 1, stiffly
/// stable. `nodes`: 1 or more; 1 is the implicit Euler method. @throws std::invalid_argument for
/// fewer.
TranscriptionScheme FlippedRadau(int nodes);
/// Any nodes from 0 to 1; those at the ends may be without a value.
/// @throws std::invalid_argument unless they ascend from 0 to 1, and if none has a value.
TranscriptionScheme SchemeOfNodes(const std::string& name, const std::vector<double>& nodes,
                                  bool separated, bool value_at_start = true,
                                  bool value_at_end = true);

}  // namespace possibility::collocation
