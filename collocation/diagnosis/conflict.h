#pragma once

#include <Eigen/Core>
#include <vector>

#include "collocation/problem/nonlinear_program.h"
#include "collocation/solver/solver.h"
#include "common/cancellation_token.h"

namespace possibility::collocation {

/// A row or a bound that stands against others.
struct ConflictMember {
  enum class Kind {
    kRow,    ///< a constraint
    kLower,  ///< a variable's bounds
    kUpper,
    kFixed
  };
  Kind kind = Kind::kRow;
  int index = 0;      ///< of the row or variable
  double weight = 0;  ///< share of the greatest multiplier, 0 to 1
};

/// The rows and bounds of a program that cannot hold together.
struct Conflict {
  Eigen::VectorXd x;     ///< where the sum of all violations of rows is least, within the bounds
  double violation = 0;  ///< that sum, scaled
  /// Those with a multiplier there: their gradients balance, so as long as they all stand, no
  /// neighbouring point violates less. Heaviest first; empty if the rows can hold.
  std::vector<ConflictMember> members;
};

/// Minimises the sum of the violations of all rows from `x`, instead of the objective.
/// Local, like every solve. @throws as Solve does, Cancelled if cancelled.
Conflict FindConflict(NonlinearProgram* program, const Eigen::VectorXd& x,
                      const SolverOptions& options = {},
                      const CancellationToken& cancellation = {});

}  // namespace possibility::collocation
