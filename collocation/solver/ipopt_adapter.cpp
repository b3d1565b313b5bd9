#include "collocation/solver/ipopt_adapter.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace possibility::collocation {
namespace {

using Eigen::VectorXd;

void Write(const VectorXd& from, double* to) { std::copy(from.begin(), from.end(), to); }

VectorXd Read(const double* from, int size) { return Eigen::Map<const VectorXd>(from, size); }

void WritePattern(const SparsityPattern& pattern, int* rows, int* columns) {
  std::copy(pattern.rows.begin(), pattern.rows.end(), rows);
  std::copy(pattern.columns.begin(), pattern.columns.end(), columns);
}

}  // namespace

IpoptAdapter::IpoptAdapter(NonlinearProgram* program, const SolverGuess& guess, SolveClock* clock,
                           const Log& log, SolverResult* result)
    : program_(program), guess_(guess), clock_(clock), log_(log), result_(result) {}

bool IpoptAdapter::get_nlp_info(int& n, int& m, int& jacobian_entries, int& hessian_entries,
                                IndexStyleEnum& index_style) {
  n = program_->num_variables();
  m = program_->num_constraints();
  jacobian_entries = program_->jacobian_pattern().size();
  hessian_entries = program_->hessian_pattern().size();
  index_style = C_STYLE;
  return true;
}

bool IpoptAdapter::get_bounds_info(int, double* x_lower, double* x_upper, int, double* g_lower,
                                   double* g_upper) {
  Write(program_->lower(), x_lower);
  Write(program_->upper(), x_upper);
  Write(program_->constraint_lower(), g_lower);
  Write(program_->constraint_upper(), g_upper);
  return true;
}

bool IpoptAdapter::get_starting_point(int, bool init_x, double* x, bool init_z, double* z_lower,
                                      double* z_upper, int, bool init_lambda, double* lambda) {
  if (init_x) Write(guess_.x, x);
  if (init_z) {
    Write(guess_.lower_multipliers, z_lower);
    Write(guess_.upper_multipliers, z_upper);
  }
  if (init_lambda) Write(guess_.constraint_multipliers, lambda);
  return true;
}

bool IpoptAdapter::Evaluate(const double* x, int* count, double* seconds,
                            const std::function<void()>& function,
                            const std::function<std::string(int)>& what) {
  if (exception_ || !clock_->Proceed()) return false;
  const SolveTimer timer(*clock_, seconds);
  ++*count;
  x_ = Read(x, program_->num_variables());
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

bool IpoptAdapter::eval_f(int, const double* x, bool, double& value) {
  values_.resize(1);
  const bool good = Evaluate(
      x, &result_->evaluations.objective, &result_->times.functions,
      [&] { values_[0] = program_->Objective(x_); }, [](int) { return "the objective"; });
  if (good) value = values_[0];
  return good;
}

bool IpoptAdapter::eval_grad_f(int n, const double* x, bool, double* gradient) {
  values_.resize(n);
  const bool good = Evaluate(
      x, &result_->evaluations.gradient, &result_->times.derivatives,
      [&] { program_->Gradient(x_, &values_); },
      [&](int k) {
        return fmt::format("the derivative of the objective with respect to '{}'",
                           program_->VariableName(k));
      });
  if (good) Write(values_, gradient);
  return good;
}

bool IpoptAdapter::eval_g(int, const double* x, bool, int m, double* g) {
  values_.resize(m);
  const bool good = Evaluate(
      x, &result_->evaluations.constraints, &result_->times.functions,
      [&] { program_->Constraints(x_, &values_); },
      [&](int k) { return fmt::format("constraint '{}'", program_->ConstraintName(k)); });
  if (good) Write(values_, g);
  return good;
}

bool IpoptAdapter::eval_jac_g(int, const double* x, bool, int, int entries, int* rows, int* columns,
                              double* values) {
  const SparsityPattern& pattern = program_->jacobian_pattern();
  if (values == nullptr) {
    WritePattern(pattern, rows, columns);
    return true;
  }
  values_.resize(entries);
  const bool good = Evaluate(
      x, &result_->evaluations.jacobian, &result_->times.derivatives,
      [&] { program_->Jacobian(x_, &values_); },
      [&](int k) {
        return fmt::format("the derivative of constraint '{}' with respect to '{}'",
                           program_->ConstraintName(pattern.rows[k]),
                           program_->VariableName(pattern.columns[k]));
      });
  if (good) Write(values_, values);
  return good;
}

bool IpoptAdapter::eval_h(int, const double* x, bool, double objective_factor, int m,
                          const double* lambda, bool, int entries, int* rows, int* columns,
                          double* values) {
  const SparsityPattern& pattern = program_->hessian_pattern();
  if (values == nullptr) {
    WritePattern(pattern, rows, columns);
    return true;
  }
  values_.resize(entries);
  const VectorXd multipliers = Read(lambda, m);
  const bool good = Evaluate(
      x, &result_->evaluations.hessian, &result_->times.derivatives,
      [&] { program_->Hessian(x_, objective_factor, multipliers, &values_); },
      [&](int k) {
        return fmt::format("the second derivative with respect to '{}' and '{}'",
                           program_->VariableName(pattern.rows[k]),
                           program_->VariableName(pattern.columns[k]));
      });
  if (good) Write(values_, values);
  return good;
}

bool IpoptAdapter::intermediate_callback(Ipopt::AlgorithmMode mode, int iteration, double objective,
                                         double primal_infeasibility, double dual_infeasibility,
                                         double mu, double, double regularisation, double,
                                         double alpha_primal, int, const Ipopt::IpoptData*,
                                         Ipopt::IpoptCalculatedQuantities*) {
  if (exception_) return false;
  const SolverIteration entry{
      iteration, objective,    primal_infeasibility, dual_infeasibility,
      mu,        alpha_primal, regularisation,       mode == Ipopt::RestorationPhaseMode};
  result_->history.push_back(entry);
  try {
    if (log_) log_(entry);
  } catch (...) {
    exception_ = std::current_exception();
    return false;
  }
  return clock_->Proceed();
}

void IpoptAdapter::finalize_solution(Ipopt::SolverReturn, int n, const double* x,
                                     const double* z_lower, const double* z_upper, int m,
                                     const double*, const double* lambda, double,
                                     const Ipopt::IpoptData*, Ipopt::IpoptCalculatedQuantities*) {
  result_->x = Read(x, n);
  result_->lower_multipliers = Read(z_lower, n);
  result_->upper_multipliers = Read(z_upper, n);
  result_->constraint_multipliers = Read(lambda, m);
}

}  // namespace possibility::collocation
