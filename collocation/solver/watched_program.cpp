#include "collocation/solver/watched_program.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace possibility::collocation {
namespace {

using Eigen::VectorXd;

void CopyTo(const VectorXd& from, double* to) { std::copy(from.begin(), from.end(), to); }

}  // namespace

WatchedProgram::WatchedProgram(NonlinearProgram* program, SolveClock* clock, const Log& log,
                               SolverResult* result)
    : program_(program), clock_(clock), log_(log), result_(result) {}

bool WatchedProgram::Evaluate(const double* x, int* count, double* seconds,
                              const std::function<void()>& function,
                              const std::function<std::string(int)>& what) {
  if (exception_ || !clock_->Proceed()) return false;
  const SolveTimer timer(*clock_, seconds);
  ++*count;
  x_ = Eigen::Map<const VectorXd>(x, program_->num_variables());
  const auto expected = values_.size();
  try {
    function();
  } catch (const std::runtime_error& error) {
    culprit_ = error.what();
    return false;
  } catch (...) {
    exception_ = std::current_exception();
    return false;
  }
  if (values_.size() != expected) {
    exception_ = std::make_exception_ptr(std::logic_error(fmt::format(
        "{}: the program gave {} values instead of {}", what(0), values_.size(), expected)));
    return false;
  }
  if (values_.allFinite()) return true;
  int k = 0;
  while (std::isfinite(values_[k])) ++k;
  culprit_ = fmt::format("{} is {}", what(k), values_[k]);
  return false;
}

bool WatchedProgram::Objective(const double* x, double* value) {
  values_.resize(1);
  const bool good = Evaluate(
      x, &result_->evaluations.objective, &result_->times.functions,
      [&] { values_[0] = program_->Objective(x_); }, [](int) { return "the objective"; });
  if (good) *value = values_[0];
  return good;
}

bool WatchedProgram::Gradient(const double* x, double* gradient) {
  values_.resize(program_->num_variables());
  const bool good = Evaluate(
      x, &result_->evaluations.gradient, &result_->times.derivatives,
      [&] { program_->Gradient(x_, &values_); },
      [&](int k) {
        return fmt::format("the derivative of the objective with respect to '{}'",
                           program_->VariableName(k));
      });
  if (good) CopyTo(values_, gradient);
  return good;
}

bool WatchedProgram::Constraints(const double* x, double* g) {
  values_.resize(program_->num_constraints());
  const bool good = Evaluate(
      x, &result_->evaluations.constraints, &result_->times.functions,
      [&] { program_->Constraints(x_, &values_); },
      [&](int k) { return fmt::format("constraint '{}'", program_->ConstraintName(k)); });
  if (good) CopyTo(values_, g);
  return good;
}

bool WatchedProgram::Jacobian(const double* x, double* values) {
  const SparsityPattern& pattern = program_->jacobian_pattern();
  values_.resize(pattern.size());
  const bool good = Evaluate(
      x, &result_->evaluations.jacobian, &result_->times.derivatives,
      [&] { program_->Jacobian(x_, &values_); },
      [&](int k) {
        return fmt::format("the derivative of constraint '{}' with respect to '{}'",
                           program_->ConstraintName(pattern.rows[k]),
                           program_->VariableName(pattern.columns[k]));
      });
  if (good) CopyTo(values_, values);
  return good;
}

bool WatchedProgram::Hessian(const double* x, double objective_factor, const double* multipliers,
                             double* values) {
  const SparsityPattern& pattern = program_->hessian_pattern();
  values_.resize(pattern.size());
  const VectorXd lambda = Eigen::Map<const VectorXd>(multipliers, program_->num_constraints());
  const bool good = Evaluate(
      x, &result_->evaluations.hessian, &result_->times.derivatives,
      [&] { program_->Hessian(x_, objective_factor, lambda, &values_); },
      [&](int k) {
        return fmt::format("the second derivative with respect to '{}' and '{}'",
                           program_->VariableName(pattern.rows[k]),
                           program_->VariableName(pattern.columns[k]));
      });
  if (good) CopyTo(values_, values);
  return good;
}

bool WatchedProgram::Report(const SolverIteration& iteration) {
  if (exception_) return false;
  result_->history.push_back(iteration);
  try {
    if (log_) log_(iteration);
  } catch (...) {
    exception_ = std::current_exception();
    return false;
  }
  return clock_->Proceed();
}

}  // namespace possibility::collocation
