#include "collocation/transcription/transcription_scheme.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>
#include <stdexcept>

#include "collocation/transcription/quadrature.h"

namespace possibility::collocation {

namespace {

void CheckNumber(int nodes, int least) {
  if (nodes >= least) return;
  throw std::invalid_argument(
      fmt::format("transcription scheme: {} nodes, expected {} or more", nodes, least));
}

/// The eigenvalues of a recurrence (lower triangle), moved from [-1, 1] to [0, 1].
void AppendRoots(const Eigen::MatrixXd& recurrence, std::vector<double>* shares) {
  if (recurrence.rows() == 0) return;
  const Eigen::VectorXd roots =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(recurrence, Eigen::EigenvaluesOnly)
          .eigenvalues();
  for (const double root : roots) shares->push_back((1 + root) / 2);
}

}  // namespace

Eigen::VectorXd TranscriptionScheme::LagrangeIntegrals(double c, int k) const {
  Eigen::VectorXd integrals = Eigen::VectorXd::Zero(num_nodes());
  double power = 1;
  for (int step = 1; step <= k; ++step) power *= c;
  for (int p = 0; p < num_nodes(); ++p) {
    double integrated = power;  // c^p, k times
    for (int step = 1; step <= k; ++step) integrated /= p + step;
    integrals += integrated * lagrange.row(p).transpose();
    power *= c;
  }
  return integrals;
}

Eigen::VectorXd TranscriptionScheme::LagrangeSlopes(double c) const {
  Eigen::VectorXd slopes = Eigen::VectorXd::Zero(num_nodes());
  double power = 1;
  for (int p = 1; p < num_nodes(); ++p) {
    slopes += p * power * lagrange.row(p).transpose();
    power *= c;
  }
  return slopes;
}

TranscriptionScheme SchemeOfNodes(const std::string& name, const std::vector<double>& nodes,
                                  bool separated, bool value_at_start, bool value_at_end) {
  bool ascends = nodes.size() >= 2 && nodes.front() == 0 && nodes.back() == 1;
  for (std::size_t i = 1; i < nodes.size(); ++i) ascends = ascends && nodes[i] > nodes[i - 1];
  if (!ascends) {
    throw std::invalid_argument(
        fmt::format("transcription scheme '{}': nodes must ascend from 0 to 1", name));
  }
  TranscriptionScheme scheme{name, nodes, value_at_start, value_at_end, separated, {}, {}};
  const int n = scheme.num_nodes();
  std::vector<int> valued;
  for (int i = 0; i < n; ++i) {
    if (scheme.HasValue(i)) valued.push_back(i);
  }
  if (valued.empty()) {
    throw std::invalid_argument(
        fmt::format("transcription scheme '{}': no node has a value", name));
  }
  const int m = static_cast<int>(valued.size());
  Eigen::MatrixXd powers(m, m);  // row i: powers of the i-th node with a value
  for (int i = 0; i < m; ++i) {
    for (int p = 0; p < m; ++p) powers(i, p) = std::pow(nodes[valued[i]], p);
  }
  const Eigen::MatrixXd lagrange = powers.partialPivLu().solve(Eigen::MatrixXd::Identity(m, m));
  scheme.lagrange = Eigen::MatrixXd::Zero(n, n);
  for (int i = 0; i < m; ++i) scheme.lagrange.col(valued[i]).head(m) = lagrange.col(i);
  for (int k = 0; k <= 2; ++k) {
    Eigen::MatrixXd integral(n, n);
    for (int i = 0; i < n; ++i) {
      integral.row(i) = scheme.LagrangeIntegrals(nodes[i], k).transpose();
    }
    scheme.integral.push_back(integral);
  }
  return scheme;
}

TranscriptionScheme Trapezoidal() { return SchemeOfNodes("trapezoidal", {0, 1}, true); }

TranscriptionScheme HermiteSimpson() { return SchemeOfNodes("hermite_simpson", {0, 0.5, 1}, true); }

TranscriptionScheme CompressedHermiteSimpson() {
  return SchemeOfNodes("hermite_simpson_compressed", {0, 0.5, 1}, false);
}

TranscriptionScheme LegendreGauss(int nodes) {
  CheckNumber(nodes, 1);
  std::vector<double> shares = {0};
  for (const QuadraturePoint& point : GaussLegendre(nodes)) shares.push_back(point.share);
  shares.push_back(1);
  return SchemeOfNodes(fmt::format("legendre_gauss_{}", nodes), shares, true, false, false);
}

TranscriptionScheme FlippedRadau(int nodes) {
  CheckNumber(nodes, 1);
  // The inner nodes are the roots of the Jacobi polynomial for the weight 1 - x, from its
  // three-term recurrence (Golub & Welsch 1969).
  const int inner = nodes - 1;
  Eigen::MatrixXd recurrence = Eigen::MatrixXd::Zero(inner, inner);
  for (int k = 0; k < inner; ++k) {
    recurrence(k, k) = -1 / ((2 * k + 1.0) * (2 * k + 3));
    if (k > 0) recurrence(k, k - 1) = std::sqrt(k * (k + 1.0)) / (2 * k + 1);
  }
  std::vector<double> shares = {0};
  AppendRoots(recurrence, &shares);
  shares.push_back(1);
  return SchemeOfNodes(fmt::format("flipped_radau_{}", nodes), shares, true, false, true);
}

TranscriptionScheme GaussLobatto(int nodes) {
  CheckNumber(nodes, 2);
  // The inner nodes are the roots of the Jacobi polynomial for the weight 1 - x^2: eigenvalues of
  // its three-term recurrence (Golub & Welsch 1969).
  const int inner = nodes - 2;
  Eigen::MatrixXd recurrence = Eigen::MatrixXd::Zero(inner, inner);
  for (int k = 1; k < inner; ++k) {
    recurrence(k, k - 1) = std::sqrt(k * (k + 2.0) / ((2 * k + 1.0) * (2 * k + 3)));
  }
  std::vector<double> shares = {0};
  AppendRoots(recurrence, &shares);
  shares.push_back(1);
  return SchemeOfNodes(fmt::format("gauss_lobatto_{}", nodes), shares, true);
}

}  // namespace possibility::collocation
