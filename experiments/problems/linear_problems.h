#pragma once

#include "experiments/problems/regression_problems.h"

namespace possibility::experiments {

std::vector<RegressionProblem> LinearProblems();

}  // namespace possibility::experiments
