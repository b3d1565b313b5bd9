#pragma once

#include <functional>
#include <string>

#include "collocation/problem/nonlinear_program.h"
#include "collocation/solver/solver.h"
#include "common/cancellation_token.h"

namespace possibility::collocation {

/// A solver of nonlinear programs. OptimalControlOptions::nonlinear_solver puts one in Ipopt's
/// place.
class NonlinearSolver {
 public:
  virtual ~NonlinearSolver() = default;

  virtual std::string name() const = 0;  ///< "ipopt"
  /// Whether its results have multipliers; if not, they are zero.
  virtual bool has_multipliers() const = 0;

  /// Minimises from a guess. Does what possibility::collocation::Solve promises: asks
  /// `cancellation` at every evaluation, reports iterations to `log`, respects tolerances, limits
  /// and objective_size of the options, and fills the result even if it fails. Any number of solves
  /// may run at once, each with its own program.
  /// @throws std::invalid_argument as possibility::collocation::Solve does, and for what this
  /// solver cannot do.
  virtual SolverResult Solve(NonlinearProgram* program, const SolverGuess& guess,
                             const SolverOptions& options, const CancellationToken& cancellation,
                             const std::function<void(const SolverIteration&)>& log) const = 0;
};

/// The default: Ipopt, as possibility::collocation::Solve calls it.
const NonlinearSolver& IpoptSolver();

}  // namespace possibility::collocation
