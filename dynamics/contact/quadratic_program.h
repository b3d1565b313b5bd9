#pragma once

#include <Eigen/Core>

namespace possibility::dynamics {

/// minimise 1/2 x' H x + g' x   over x (n)
/// subject to  E x = e  (rows may be dependent if consistent),  C x <= d.
/// H symmetric positive definite. Small and dense: tens of variables and rows.
struct QuadraticProgram {
  Eigen::MatrixXd H;
  Eigen::VectorXd g;
  Eigen::MatrixXd E;
  Eigen::VectorXd e;
  Eigen::MatrixXd C;
  Eigen::VectorXd d;
  /// To which dependent rows of E are consistent, relative to the sizes of x and of the bound.
  double equality_tolerance = 1e-11;
};

enum class QuadraticProgramStatus { kSolved, kInfeasible, kIterationLimit };

struct QuadraticProgramSolution {
  QuadraticProgramStatus status = QuadraticProgramStatus::kIterationLimit;
  Eigen::VectorXd x;
  /// Multipliers of the Lagrangian 1/2 x'Hx + g'x + y'(Ex - e) + z'(Cx - d); z >= 0. Filled if
  /// kSolved.
  Eigen::VectorXd y;
  Eigen::VectorXd z;
  int iterations = 0;
};

/// Dual active-set method (Goldfarb & Idnani 1983). Constraints hold to a relative 1e-11,
/// dependent equalities to equality_tolerance.
/// @throws std::invalid_argument if sizes disagree, a number is not finite or H is not positive
/// definite.
QuadraticProgramSolution Solve(const QuadraticProgram& program);

}  // namespace possibility::dynamics
