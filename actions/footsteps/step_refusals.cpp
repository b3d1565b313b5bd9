#include "actions/footsteps/step_refusals.h"

#include <algorithm>
#include <cmath>

namespace possibility::actions {
namespace {

/// Steps that differ by less are the same, m and rad.
constexpr double kSame = 0.01;

double TiltOf(const Foothold& place) {
  return std::atan2(place.normal.head<2>().norm(), place.normal.z());
}

}  // namespace

StepRefusals::Measures StepRefusals::Of(const Footstep& step, const Foothold& other) {
  const auto distance = [&other](const Foothold& place) {
    return (place.stance.position() - other.stance.position()).norm();
  };
  return {distance(step.from),
          std::max(0.0, step.from.z - other.z),
          std::max(0.0, other.z - step.from.z),
          distance(step.to),
          std::max(0.0, step.to.z - other.z),
          std::max(0.0, other.z - step.to.z),
          step.lift,
          TiltOf(step.from),
          TiltOf(step.to),
          TiltOf(other)};
}

bool StepRefusals::Refuses(const Footstep& step, const Foothold& other) const {
  const Measures measures = Of(step, other);
  return std::any_of(refused_.begin(), refused_.end(), [&](const Measures& refused) {
    for (std::size_t i = 0; i < measures.size(); ++i) {
      if (measures[i] < refused[i] - kSame) return false;
    }
    return true;
  });
}

}  // namespace possibility::actions
