#pragma once

#include <memory>

#include "collocation/problem/optimal_control_problem.h"

namespace possibility::experiments {

/// Hopper jumps `distance` (m) from rest to rest, in three phases with a rigid impact. Minimises
/// the integral of squared efforts.
std::unique_ptr<collocation::OptimalControlProblem> Hop(double distance);

}  // namespace possibility::experiments
