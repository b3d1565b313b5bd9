#pragma once

#include <string>

#include "collocation/solver/solver.h"

namespace possibility::collocation {

/// As files and other languages spell it, such as "iteration_limit".
std::string StatusName(SolverStatus status);

}  // namespace possibility::collocation
