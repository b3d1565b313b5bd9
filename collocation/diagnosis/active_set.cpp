#include "collocation/diagnosis/active_set.h"

#include <algorithm>
#include <cmath>

namespace possibility::collocation {
namespace {

// An interior-point method ends where distance times multiplier is its barrier parameter. Where
// neither is clearly the larger one, both may be zero at the solution.
constexpr double kClear = 1e3;
constexpr double kLeast = 1e-6;

Hold HoldOfSide(double distance, double multiplier) {
  const double apart = std::max(distance, 0.0), push = std::max(multiplier, 0.0);
  if (push > std::max(kLeast, kClear * apart)) return Hold::kFirm;
  if (apart > std::max(kLeast, kClear * push)) return Hold::kFree;
  return Hold::kWeak;
}

Hold HoldOf(double lower, double upper, double value, double push_up, double push_down) {
  if (lower == upper) return Hold::kFirm;
  return std::max(HoldOfSide(value - lower, push_up), HoldOfSide(upper - value, push_down));
}

}  // namespace

ActiveSet ActiveSetOf(const NonlinearProgram& program, const SolverResult& result,
                      double objective_size) {
  ActiveSet active;
  for (int i = 0; i < program.num_variables(); ++i) {
    active.variables.push_back(HoldOf(program.lower()[i], program.upper()[i], result.x[i],
                                      result.lower_multipliers[i] / objective_size,
                                      result.upper_multipliers[i] / objective_size));
  }
  for (int row = 0; row < program.num_constraints(); ++row) {
    const double multiplier = result.constraint_multipliers[row] / objective_size;
    active.rows.push_back(HoldOf(program.constraint_lower()[row], program.constraint_upper()[row],
                                 result.constraints[row], -multiplier, multiplier));
  }
  return active;
}

}  // namespace possibility::collocation
