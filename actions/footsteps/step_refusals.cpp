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

template <typename Measures>
bool IsAtLeast(const Measures& measures, const Measures& refused) {
  return std::equal(measures.begin(), measures.end(), refused.begin(),
                    [](double measure, double least) { return measure >= least - kSame; });
}

template <typename Measures>
bool IsAtLeastOneOf(const Measures& measures, const std::vector<Measures>& refused) {
  return std::any_of(refused.begin(), refused.end(),
                     [&measures](const Measures& one) { return IsAtLeast(measures, one); });
}

}  // namespace

StepRefusals::StepMeasures StepRefusals::Of(const Footstep& step, const Foothold& other) {
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

StepRefusals::EndMeasures StepRefusals::Of(const Foothold& place, const Foothold& other) {
  const PlanarPose away = other.stance.Inverse() * place.stance;
  const double outward = std::copysign(1, away.y) * WrapAngle(away.yaw);
  return {std::max(0.0, away.x),
          std::max(0.0, -away.x),
          std::abs(away.y),
          std::max(0.0, place.z - other.z),
          std::max(0.0, other.z - place.z),
          std::max(0.0, outward),
          std::max(0.0, -outward),
          TiltOf(place),
          TiltOf(other)};
}

bool StepRefusals::Refuses(const Footstep& step, const Foothold& other) const {
  if (IsAtLeastOneOf(Of(step, other), steps_)) return true;
  if (ends_.empty()) return false;
  return IsAtLeastOneOf(Of(step.from, other), ends_) || IsAtLeastOneOf(Of(step.to, other), ends_);
}

}  // namespace possibility::actions
