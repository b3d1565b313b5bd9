#pragma once

#include "collocation/solver/solver.h"

namespace possibility::actions {

/// How problems of SagittalProblem are solved: to `tolerance` in optimality and 1e-7 in
/// feasibility.
///
/// Their guesses are far from feasible whatever the barrier is, so it begins low and falls
/// monotonically. The guess is moved well inside its bounds, whose multipliers begin near those of
/// the barrier, so that the first steps are long. Medians of iterations over 21 jumps of 0.3 to 0.7
/// m by -0.2 to 0.2 m on the first mesh: 29. With Ipopt's own distance from the bounds (0.01) and
/// multipliers (1) it is 42, with a barrier of 1e-3 besides 45.
/// `from_solution`: the solve starts from a solution with multipliers. The barrier begins where it
/// ended.
collocation::SolverOptions SagittalSolverOptions(double tolerance, bool from_solution = false);

/// The same, but the barrier stays where it begins. The motion is as feasible and keeps a little
/// farther from its bounds; the cost is some percent above the least.
collocation::SolverOptions SagittalSolverOptionsWithinBarrier();

}  // namespace possibility::actions
