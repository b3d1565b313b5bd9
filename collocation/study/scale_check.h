#pragma once

#include "collocation/problem/optimal_control_problem.h"

namespace possibility::collocation {

/// Refuses scales that hide a quantity: the solver holds bounds to `constraint_tolerance` times the
/// scale, so a quantity whose bounds are all that small could have any value.
/// @throws std::invalid_argument naming phase and quantity.
void CheckScales(const OptimalControlProblem& problem, double constraint_tolerance);

}  // namespace possibility::collocation
