#include "collocation/transcription/quadrature.h"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace possibility::collocation {

std::vector<QuadraturePoint> GaussLegendre(int points) {
  // Eigenvalues of the three-term recurrence of Legendre's polynomials and the squared first
  // elements of its eigenvectors (Golub & Welsch 1969).
  Eigen::MatrixXd recurrence = Eigen::MatrixXd::Zero(points, points);
  for (int k = 1; k < points; ++k) {
    recurrence(k, k - 1) = k / std::sqrt(4.0 * k * k - 1);
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(recurrence);
  std::vector<QuadraturePoint> rule;
  for (int i = 0; i < points; ++i) {
    const double first = solver.eigenvectors()(0, i);
    rule.push_back({(1 + solver.eigenvalues()[i]) / 2, first * first});
  }
  return rule;
}

}  // namespace possibility::collocation
