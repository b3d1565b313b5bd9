#pragma once

#include <Eigen/Core>
#include <exception>
#include <functional>
#include <string>

#include "collocation/problem/nonlinear_program.h"
#include "collocation/solver/solve_clock.h"
#include "collocation/solver/solver.h"

namespace possibility::collocation {

/// The functions of a program during a solve, for solvers that keep vectors as arrays and know no
/// exceptions. Each asks the clock first, counts itself, adds its time to the result and returns
/// false, with nothing written, if the solve must stop, the program throws, or a value is not
/// finite.
class WatchedProgram {
 public:
  using Log = std::function<void(const SolverIteration&)>;

  /// Everything passed must outlive this.
  WatchedProgram(NonlinearProgram* program, SolveClock* clock, const Log& log,
                 SolverResult* result);

  const NonlinearProgram& inner() const { return *program_; }

  bool Objective(const double* x, double* value);
  bool Gradient(const double* x, double* gradient);
  bool Constraints(const double* x, double* g);
  /// Values in the order of the pattern; likewise Hessian.
  bool Jacobian(const double* x, double* values);
  bool Hessian(const double* x, double objective_factor, const double* multipliers, double* values);
  /// Adds to the history and calls the log. False if the solve must stop.
  bool Report(const SolverIteration& iteration);

  /// Name of the last function that was not finite, or empty.
  const std::string& culprit() const { return culprit_; }
  /// Whether the program or the log threw anything but std::runtime_error. Everything after it is
  /// refused.
  bool has_thrown() const { return exception_ != nullptr; }
  /// Throws it again, if there is one.
  void Rethrow() const {
    if (exception_) std::rethrow_exception(exception_);
  }

 private:
  bool Evaluate(const double* x, int* count, double* seconds, const std::function<void()>& function,
                const std::function<std::string(int)>& what);

  NonlinearProgram* program_;
  SolveClock* clock_;
  const Log& log_;
  SolverResult* result_;
  Eigen::VectorXd x_;
  Eigen::VectorXd values_;
  std::string culprit_;
  std::exception_ptr exception_;
};

}  // namespace possibility::collocation
