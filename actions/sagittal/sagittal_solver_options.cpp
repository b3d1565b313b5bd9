#include "actions/sagittal/sagittal_solver_options.h"

#include <fmt/format.h>

namespace possibility::actions {

collocation::SolverOptions SagittalSolverOptions(double tolerance, bool from_solution) {
  collocation::SolverOptions options;
  options.tolerance = tolerance;
  options.constraint_tolerance = 1e-7;
  options.ipopt = {{"mu_strategy", "monotone"},
                   {"mu_init", fmt::format("{:g}", from_solution ? tolerance / 10 : 1e-4)},
                   {"bound_push", "0.1"},
                   {"bound_frac", "0.1"},
                   {"bound_mult_init_val", "0.01"}};
  return options;
}

}  // namespace possibility::actions
