#pragma once

#include <vector>

namespace possibility::collocation {

/// One point of a quadrature over [0, 1].
struct QuadraturePoint {
  double share;
  double weight;  ///< all of them sum up to 1
};

/// Gauss and Legendre's rule, ascending: exact for polynomials of degree 2 points - 1. `points`: 1
/// or more.
std::vector<QuadraturePoint> GaussLegendre(int points);

}  // namespace possibility::collocation
