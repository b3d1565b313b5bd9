#include "experiments/samples/plan_samples.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

#include "models/input/input_error.h"

namespace possibility::experiments {
namespace {

constexpr double kMaxSamples = 1e8;

PlanSample SampleAt(int segment, const actions::Phase& phase, double t) {
  const auto after =
      std::upper_bound(phase.knots.begin() + 1, phase.knots.end() - 1, t,
                       [](double time, const actions::Knot& knot) { return time < knot.t; });
  const actions::Knot& before = *(after - 1);
  const double inside = std::clamp(t, before.t, after->t);
  return {segment, &phase, actions::Interpolate(before, *after, inside),
          inside == before.t || inside == after->t};
}

}  // namespace

void VisitKnots(const actions::Plan& plan, const VisitSample& visit) {
  for (std::size_t i = 0; i < plan.segments.size(); ++i) {
    for (const actions::Phase& phase : plan.segments[i].phases) {
      for (const actions::Knot& knot : phase.knots) visit({static_cast<int>(i), &phase, knot});
    }
  }
}

void VisitEvery(const actions::Plan& plan, double period, const VisitSample& visit) {
  if (plan.duration() / period > kMaxSamples) {
    throw InputError(fmt::format("--period: {} s gives over {} rows, expected a longer period",
                                 period, kMaxSamples));
  }
  std::int64_t index = 0;
  double begin = 0;
  PlanSample last;
  for (std::size_t i = 0; i < plan.segments.size(); ++i) {
    for (const actions::Phase& phase : plan.segments[i].phases) {
      if (last.phase == nullptr) begin = phase.knots.front().t;
      for (double t = begin + index * period; t < phase.knots.back().t;
           t = begin + index * period) {
        visit(SampleAt(static_cast<int>(i), phase, t));
        ++index;
      }
      last = {static_cast<int>(i), &phase, phase.knots.back()};
    }
  }
  if (last.phase != nullptr) visit(last);
}

}  // namespace possibility::experiments
