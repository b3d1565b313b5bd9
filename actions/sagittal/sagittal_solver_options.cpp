#include "actions/sagittal/sagittal_solver_options.h"

#include <fmt/format.h>

namespace possibility::actions {
namespace {

constexpr double kFirstBarrier = 1e-4;

}  // namespace

collocation::SolverOptions SagittalSolverOptions(double tolerance, bool from_solution) {
  collocation::SolverOptions options;
  options.tolerance = tolerance;
  options.constraint_tolerance = 1e-7;
  options.ipopt = {{"mu_strategy", "monotone"},
                   {"mu_init", fmt::format("{:g}", from_solution ? tolerance / 10 : kFirstBarrier)},
                   {"bound_push", "0.1"},
                   {"bound_frac", "0.1"},
                   {"bound_mult_init_val", "0.01"}};
  return options;
}

collocation::SolverOptions SagittalSolverOptionsWithinBarrier() {
  // Ipopt lowers a monotone barrier to the tolerance over barrier_tol_factor + 1 = 11, and no more.
  constexpr double kTolerance = 11.01 * kFirstBarrier;
  collocation::SolverOptions options = SagittalSolverOptions(kTolerance);
  options.ipopt.emplace_back("compl_inf_tol", fmt::format("{:g}", kTolerance));
  // So far from feasible, the multipliers of least squares are too large to be used.
  options.ipopt.emplace_back("constr_mult_init_max", "0");
  return options;
}

}  // namespace possibility::actions
