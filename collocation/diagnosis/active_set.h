#pragma once

#include <vector>

#include "collocation/problem/nonlinear_program.h"
#include "collocation/solver/solver.h"

namespace possibility::collocation {

/// How a bound holds a variable or a row at a solution.
enum class Hold {
  kFree,  ///< not at a bound
  kWeak,  ///< at a bound or close to it, but without a clear multiplier
  kFirm   ///< at a bound that pushes, or fixed
};

struct ActiveSet {
  std::vector<Hold> variables;
  std::vector<Hold> rows;
};

/// Which bounds and rows hold at a solution, from distances and multipliers. Both are of order one
/// where they are not zero, the multipliers beside `objective_size`.
ActiveSet ActiveSetOf(const NonlinearProgram& program, const SolverResult& result,
                      double objective_size);

}  // namespace possibility::collocation
