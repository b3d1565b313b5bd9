#pragma once

#include "experiments/problems/regression_problems.h"

namespace possibility::experiments {

std::vector<RegressionProblem> ConstrainedProblems();

}  // namespace possibility::experiments
