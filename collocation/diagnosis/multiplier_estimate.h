#pragma once

#include <Eigen/Core>

#include "collocation/problem/nonlinear_program.h"

namespace possibility::collocation {

/// First-order conditions at a point.
struct MultiplierEstimate {
  Eigen::VectorXd rows, lower, upper;  ///< with signs as in SolverResult
  /// Largest element of the gradient of the Lagrangian among variables that no bound holds.
  double residual = 0;
  double gradient = 0;  ///< largest element of the objective's gradient
};

/// The multipliers with which the gradients at `x` balance best (least squares), for solvers that
/// give none. Bounds and rows within `distance` of x may hold; those that would pull are released.
/// Dense: for small programs. @throws what the program's functions throw.
MultiplierEstimate EstimateMultipliers(NonlinearProgram* program, const Eigen::VectorXd& x,
                                       double distance);

}  // namespace possibility::collocation
