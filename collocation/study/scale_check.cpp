#include "collocation/study/scale_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace possibility::collocation {
namespace {

/// Greatest finite bound of a quantity, in magnitude.
double Reach(const std::vector<std::pair<At, Bounds>>& bounds) {
  double reach = 0;
  for (const auto& [at, range] : bounds) {
    for (const double bound : {range.lower, range.upper}) {
      if (std::isfinite(bound)) reach = std::max(reach, std::abs(bound));
    }
  }
  return reach;
}

void Check(const Phase& phase, const Phase::Quantity& quantity, double constraint_tolerance) {
  constexpr double kDigits = 100;  // of the tolerance: two digits of the quantity at least
  const double reach = Reach(quantity.bounds);
  if (reach == 0 || reach >= kDigits * constraint_tolerance * quantity.scale) return;
  phase.Fail(fmt::format(
      "the scale of '{}' is {:.3g}, but its bounds reach {:.3g} only: the tolerance of {:.3g} "
      "times the scale hides them",
      quantity.name, quantity.scale, reach, constraint_tolerance));
}

}  // namespace

void CheckScales(const OptimalControlProblem& problem, double constraint_tolerance) {
  for (int p = 0; p < problem.num_phases(); ++p) {
    const Phase& phase = problem.phase(p);
    for (const auto& orders : phase.coordinates()) {
      for (const Phase::Quantity& quantity : orders) {
        Check(phase, quantity, constraint_tolerance);
      }
    }
    for (const Phase::Quantity& control : phase.controls()) {
      Check(phase, control, constraint_tolerance);
    }
  }
}

}  // namespace possibility::collocation
