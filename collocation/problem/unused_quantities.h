#pragma once

#include "collocation/problem/optimal_control_problem.h"

namespace possibility::collocation {

/// @throws std::invalid_argument naming the first quantity without which the problem would be the
/// same: a coordinate whose highest derivative is in no constraint or cost and has no bounds (its
/// dynamics were forgotten), a control or a parameter in no constraint or cost.
void CheckEverythingIsUsed(const OptimalControlProblem& problem);

}  // namespace possibility::collocation
