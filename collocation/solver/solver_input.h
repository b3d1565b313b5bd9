#pragma once

#include "collocation/problem/nonlinear_program.h"
#include "collocation/solver/solver.h"

namespace possibility::collocation {

/// Whether a guess brings multipliers.
bool IsWarm(const SolverGuess& guess);

/// @throws std::invalid_argument for an empty program, contradictory bounds (naming the variable or
/// constraint), an entry outside of its matrix, a guess of a wrong size or one that is not finite.
void CheckSolverInput(const NonlinearProgram& program, const SolverGuess& guess);

}  // namespace possibility::collocation
