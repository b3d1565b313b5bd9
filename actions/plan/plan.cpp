#include "actions/plan/plan.h"

#include <algorithm>

namespace possibility::actions {
namespace {

const Knot* FirstKnot(const Plan& plan) {
  for (const Segment& segment : plan.segments) {
    for (const Phase& phase : segment.phases) {
      if (!phase.knots.empty()) return &phase.knots.front();
    }
  }
  return nullptr;
}

const Knot* LastKnot(const Plan& plan) {
  const Knot* last = nullptr;
  for (const Segment& segment : plan.segments) {
    for (const Phase& phase : segment.phases) {
      if (!phase.knots.empty()) last = &phase.knots.back();
    }
  }
  return last;
}

}  // namespace

bool HasFlightOrImpact(const Phase& phase) {
  return phase.contacts.empty() || phase.impulses.cols() > 0;
}

bool HasFlightOrImpact(const Segment& segment) {
  return std::any_of(segment.phases.begin(), segment.phases.end(),
                     [](const Phase& phase) { return HasFlightOrImpact(phase); });
}

double Plan::duration() const {
  const Knot* first = FirstKnot(*this);
  return first == nullptr ? 0 : LastKnot(*this)->t - first->t;
}

std::string ToString(PassageDimension dimension) {
  switch (dimension) {
    case PassageDimension::kWidth:
      return "width";
    case PassageDimension::kHeight:
      return "height";
    case PassageDimension::kGap:
      return "gap";
  }
  return "unknown";
}

}  // namespace possibility::actions
