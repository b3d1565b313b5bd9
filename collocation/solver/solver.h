#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "collocation/problem/nonlinear_program.h"
#include "common/cancellation_token.h"

namespace possibility::collocation {

enum class LinearSolver {
  kSparseLdlt,  ///< ours, thread-safe (docs/collocation.md)
  kMumps        ///< the reference: whole solves take turns under one lock
};

enum class HessianMode { kExact, kLimitedMemory };

struct SolverOptions {
  double tolerance = 1e-8;             ///< scaled optimality error
  double constraint_tolerance = 1e-8;  ///< greatest violation, unscaled
  /// Typical size of the objective, above 0: optimality is meant as a share of it.
  double objective_size = 1;
  int max_iterations = 1000;
  double time_limit = 0;  ///< s of wall time; 0: none. Time spent paused does not count.
  LinearSolver linear_solver = LinearSolver::kSparseLdlt;
  HessianMode hessian = HessianMode::kExact;
  /// Ipopt options by name, in Ipopt's spelling, in addition to ours.
  std::vector<std::pair<std::string, std::string>> ipopt;
};

/// The starting point of a solve: x alone, or with the multipliers of a neighbouring solution.
struct SolverGuess {
  Eigen::VectorXd x;
  /// All three or none. Sizes: num_constraints, num_variables, num_variables.
  Eigen::VectorXd constraint_multipliers;
  Eigen::VectorXd lower_multipliers;
  Eigen::VectorXd upper_multipliers;
};

struct SolverIteration {
  int number = 0;
  double objective = 0;
  double primal_infeasibility = 0;
  double dual_infeasibility = 0;
  double barrier = 0;         ///< mu
  double step_length = 0;     ///< primal alpha
  double regularisation = 0;  ///< added to the Hessian's diagonal
  bool restoration = false;
};

enum class SolverStatus {
  kSolved,
  kAcceptable,  ///< Ipopt's looser "acceptable" level, constraints within tolerance
  kInfeasible,  ///< a local minimum of the constraint violation
  kUnbounded,   ///< iterates diverge
  kIterationLimit,
  kTimeLimit,
  kCancelled,
  kInvalidNumber,    ///< a function is not finite; `message` names it
  kWrongDerivative,  ///< not solved, since a derivative is wrong (check_derivatives); see `message`
  kFailed            ///< anything else; see `message`
};

struct SolverEvaluations {
  int objective = 0;
  int gradient = 0;
  int constraints = 0;
  int jacobian = 0;
  int hessian = 0;
};

/// Breakdown of the time, s of wall time.
struct SolverTimes {
  double total = 0;
  double functions = 0;      ///< objective and constraints
  double derivatives = 0;    ///< gradient, Jacobian, Hessian
  double factorisation = 0;  ///< of the KKT systems; with MUMPS also their assembly
  double back_solves = 0;    ///< including the refinement of our own solver
  double second_order = 0;   ///< the second-order check after the last solve, if it was asked for
  double rest = 0;
};

struct SolverResult {
  SolverStatus status = SolverStatus::kFailed;
  std::string message;
  Eigen::VectorXd x;
  double objective = 0;
  double worst_violation = 0;   ///< of constraints and bounds, unscaled
  Eigen::VectorXd constraints;  ///< g(x)
  Eigen::VectorXd constraint_multipliers;
  Eigen::VectorXd lower_multipliers;
  Eigen::VectorXd upper_multipliers;
  std::vector<SolverIteration> history;
  SolverEvaluations evaluations;
  SolverTimes times;

  bool succeeded() const {
    return status == SolverStatus::kSolved || status == SolverStatus::kAcceptable;
  }
};

/// Solves with Ipopt. Any number of solves may run at once, each with its own program.
/// `cancellation` is asked at every evaluation and during factorisations. `log` is called with
/// every iteration, before the question whether to go on: what it orders always takes effect in the
/// same place. Nothing is printed.
/// @throws std::invalid_argument for an empty program, contradictory bounds (naming the variable or
/// constraint), a guess of a wrong size or one that is not finite, or an unknown Ipopt option.
SolverResult Solve(NonlinearProgram* program, const SolverGuess& guess,
                   const SolverOptions& options = {}, const CancellationToken& cancellation = {},
                   const std::function<void(const SolverIteration&)>& log = {});

}  // namespace possibility::collocation
