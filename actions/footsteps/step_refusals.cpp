#include "actions/footsteps/step_refusals.h"

#include <algorithm>
#include <cmath>

namespace possibility::actions {
namespace {

/// Steps that differ by less are the same, m and rad.
constexpr double kSame = 0.01;

using Breadth = StepRefusals::Breadth;

double TiltOf(const Foothold& place) {
  return std::atan2(place.normal.head<2>().norm(), place.normal.z());
}

template <typename Measures>
bool IsRefusedBy(const Measures& refused, const Measures& measures, Breadth breadth) {
  return std::equal(measures.begin(), measures.end(), refused.begin(),
                    [breadth](double measure, double least) {
                      return measure >= least - kSame &&
                             (breadth == Breadth::kBeyond || measure <= least + kSame);
                    });
}

template <typename Measures>
bool IsRefusedByOneOf(const std::vector<Measures>& refused, const Measures& measures,
                      Breadth breadth) {
  return std::any_of(refused.begin(), refused.end(),
                     [&](const Measures& one) { return IsRefusedBy(one, measures, breadth); });
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
  if (IsRefusedByOneOf(steps_, Of(step, other), breadth_)) return true;
  if (ends_.empty()) return false;
  return IsRefusedByOneOf(ends_, Of(step.from, other), breadth_) ||
         IsRefusedByOneOf(ends_, Of(step.to, other), breadth_);
}

}  // namespace possibility::actions
