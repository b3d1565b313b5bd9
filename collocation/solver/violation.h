#pragma once

#include <Eigen/Core>
#include <string>

#include "collocation/problem/nonlinear_program.h"
#include "collocation/solver/solver.h"

namespace possibility::collocation {

/// A violated bound or constraint.
struct Violation {
  double size = 0;      ///< scaled
  double own_size = 0;  ///< in its own unit
  std::string name;
};

/// The bound or constraint that is violated most; size 0 if all hold.
Violation WorstViolation(const NonlinearProgram& program, const Eigen::VectorXd& x,
                         const Eigen::VectorXd& g);

/// Fills in objective, constraints and violation at result->x. NaN where a function is undefined.
Violation EvaluateResult(NonlinearProgram* program, SolverResult* result);

}  // namespace possibility::collocation
