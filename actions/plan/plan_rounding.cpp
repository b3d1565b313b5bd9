#include "actions/plan/plan_rounding.h"

#include <cmath>

#include "actions/plan/plan_digits.h"

namespace possibility::actions {
namespace {

template <typename Numbers>
void RoundAll(int decimals, Numbers* numbers) {
  for (double& number : numbers->reshaped()) {
    if (std::isfinite(number)) number = Rounded(number, decimals);
  }
}

void RoundKnot(Knot* knot) {
  RoundAll(PlanDigits::kPosition, &knot->q);
  RoundAll(PlanDigits::kRate, &knot->v);
  RoundAll(PlanDigits::kAcceleration, &knot->a);
  RoundAll(PlanDigits::kForce, &knot->tau);
  RoundAll(PlanDigits::kForce, &knot->forces);
}

}  // namespace

void RoundToPlanDigits(Plan* plan) {
  for (Segment& segment : plan->segments) {
    for (Phase& phase : segment.phases) {
      RoundAll(PlanDigits::kForce, &phase.impulses);
      for (Knot& knot : phase.knots) RoundKnot(&knot);
    }
  }
}

}  // namespace possibility::actions
