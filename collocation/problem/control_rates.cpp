// Costs and bounds of the rates of a phase's controls.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "collocation/problem/optimal_control_problem.h"

namespace possibility::collocation {

namespace {

/// The greatest finite bound, in magnitude; `otherwise` if none is above 0.
double RateScale(const Bounds& bounds, double otherwise) {
  double reach = 0;
  for (const double bound : {bounds.lower, bounds.upper}) {
    if (std::isfinite(bound)) reach = std::max(reach, std::abs(bound));
  }
  return reach > 0 ? reach : otherwise;
}

}  // namespace

const Phase::Quantity& Phase::FindControl(Variable variable) const {
  const Quantity& quantity = Find(variable);
  if (variable.kind != VariableKind::kControl) {
    Fail(fmt::format(
        "'{}' is no control: the derivatives of coordinates have costs and bounds of their own",
        quantity.name));
  }
  return quantity;
}

void Phase::AddRateCost(Variable control, double weight) {
  const Quantity& quantity = FindControl(control);
  if (!std::isfinite(weight)) {
    Fail(fmt::format("the rate of '{}' has the weight {}", quantity.name, weight));
  }
  rate_costs_.push_back({control.index, weight});
}

void Phase::BoundRate(Variable control, Bounds bounds) {
  const Quantity& quantity = FindControl(control);
  auto known = std::find_if(rate_bounds_.begin(), rate_bounds_.end(),
                            [&](const RateBound& other) { return other.control == control.index; });
  if (known == rate_bounds_.end()) {
    known = rate_bounds_.insert(known, {control.index, {}, 1});
  }
  const Bounds both{std::max(known->bounds.lower, bounds.lower),
                    std::min(known->bounds.upper, bounds.upper)};
  if (Contradict(bounds) || Contradict(both)) {
    Fail(fmt::format("the rate of '{}': contradictory bounds {}", quantity.name,
                     Describe(Contradict(bounds) ? bounds : both)));
  }
  known->bounds = both;
  known->scale = RateScale(both, quantity.scale);
}

}  // namespace possibility::collocation
