#include "collocation/solver/ipopt_adapter.h"

#include <algorithm>

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
    : program_(program, clock, log, result), guess_(guess), result_(result) {}

bool IpoptAdapter::get_nlp_info(int& n, int& m, int& jacobian_entries, int& hessian_entries,
                                IndexStyleEnum& index_style) {
  n = program_.inner().num_variables();
  m = program_.inner().num_constraints();
  jacobian_entries = program_.inner().jacobian_pattern().size();
  hessian_entries = program_.inner().hessian_pattern().size();
  index_style = C_STYLE;
  return true;
}

bool IpoptAdapter::get_bounds_info(int, double* x_lower, double* x_upper, int, double* g_lower,
                                   double* g_upper) {
  Write(program_.inner().lower(), x_lower);
  Write(program_.inner().upper(), x_upper);
  Write(program_.inner().constraint_lower(), g_lower);
  Write(program_.inner().constraint_upper(), g_upper);
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

bool IpoptAdapter::eval_f(int, const double* x, bool, double& value) {
  return program_.Objective(x, &value);
}

bool IpoptAdapter::eval_grad_f(int, const double* x, bool, double* gradient) {
  return program_.Gradient(x, gradient);
}

bool IpoptAdapter::eval_g(int, const double* x, bool, int, double* g) {
  return program_.Constraints(x, g);
}

bool IpoptAdapter::eval_jac_g(int, const double* x, bool, int, int, int* rows, int* columns,
                              double* values) {
  if (values != nullptr) return program_.Jacobian(x, values);
  WritePattern(program_.inner().jacobian_pattern(), rows, columns);
  return true;
}

bool IpoptAdapter::eval_h(int, const double* x, bool, double objective_factor, int,
                          const double* lambda, bool, int, int* rows, int* columns,
                          double* values) {
  if (values != nullptr) return program_.Hessian(x, objective_factor, lambda, values);
  WritePattern(program_.inner().hessian_pattern(), rows, columns);
  return true;
}

bool IpoptAdapter::intermediate_callback(Ipopt::AlgorithmMode mode, int iteration, double objective,
                                         double primal_infeasibility, double dual_infeasibility,
                                         double mu, double, double regularisation, double,
                                         double alpha_primal, int, const Ipopt::IpoptData*,
                                         Ipopt::IpoptCalculatedQuantities*) {
  return program_.Report({iteration, objective, primal_infeasibility, dual_infeasibility, mu,
                          alpha_primal, regularisation, mode == Ipopt::RestorationPhaseMode});
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
