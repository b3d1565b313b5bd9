#pragma once

#include <initializer_list>
#include <utility>
#include <vector>

#include "experiments/problems/regression_problems.h"

namespace possibility::experiments {

/// Fixes quantities at one end of the phase.
void FixAll(collocation::Phase& phase, collocation::At end,
            std::initializer_list<std::pair<collocation::Variable, double>> values);

/// Makes the duration free, starting from the middle of its bounds, and adds it to the cost.
void MinimiseDuration(collocation::OptimalControlProblem& problem, collocation::Phase& phase,
                      collocation::Bounds bounds);

/// The only known optimum. `tolerance`: relative.
std::vector<KnownOptimum> OneOptimum(double objective, double tolerance);

}  // namespace possibility::experiments
