#pragma once

#include "collocation/problem/optimal_control_problem.h"

namespace possibility::collocation {

/// Gives a typical size to all that has none of its own, from bounds, guesses and Jacobians at the
/// guess:
/// - coordinates, controls and parameters: the greatest magnitude of finite bounds and guess;
/// - a derivative without either: that of the coordinate one order below, per duration;
/// - a control without either: what changes the highest derivative by its own size;
/// - rows of dynamics: the highest derivative's; rows of other constraints: the greatest change
/// that
///   the size of an argument makes.
/// Scales that were given explicitly, to the quantity or to the constraint, stay. Call it after
/// everything else. Integrals keep the scale 1, and rows that link phases have none.
/// @throws std::invalid_argument as VariableLayout does.
void SetAutomaticScales(OptimalControlProblem* problem);

}  // namespace possibility::collocation
