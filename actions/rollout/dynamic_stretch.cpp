#include "actions/rollout/dynamic_stretch.h"

#include <algorithm>
#include <cstddef>

namespace possibility::actions {
namespace {

constexpr double kRestSpeed = 1e-3;         // m/s and rad/s
constexpr double kRestAcceleration = 1e-2;  // m/s^2 and rad/s^2

struct PlacedPhase {
  int segment = 0;
  const Phase* phase = nullptr;
};

bool IsAtRest(const Knot& knot) {
  return knot.v.lpNorm<Eigen::Infinity>() < kRestSpeed &&
         knot.a.lpNorm<Eigen::Infinity>() < kRestAcceleration;
}

/// Whether the robot is at rest between two phases, so that the later one does not depend on the
/// earlier.
bool StandsBetween(const Phase& before, const Phase& after) {
  return !before.contacts.empty() && !after.contacts.empty() && after.impulses.cols() == 0 &&
         IsAtRest(before.knots.back()) && IsAtRest(after.knots.front());
}

DynamicStretch Stretch(std::vector<PlacedPhase>::const_iterator begin,
                       std::vector<PlacedPhase>::const_iterator end) {
  DynamicStretch stretch{begin->segment, (end - 1)->segment, {"", {}}};
  for (auto it = begin; it != end; ++it) stretch.motion.phases.push_back(*it->phase);
  return stretch;
}

}  // namespace

std::vector<DynamicStretch> DynamicStretches(const Plan& plan) {
  std::vector<PlacedPhase> phases;
  for (std::size_t s = 0; s < plan.segments.size(); ++s) {
    for (const Phase& phase : plan.segments[s].phases) {
      phases.push_back({static_cast<int>(s), &phase});
    }
  }
  std::vector<DynamicStretch> stretches;
  for (auto begin = phases.cbegin(); begin != phases.cend();) {
    auto end = begin + 1;
    while (end != phases.cend() && !StandsBetween(*(end - 1)->phase, *end->phase)) ++end;
    // Contacts that change while the robot moves make a gait dynamic.
    const bool is_dynamic =
        end - begin > 1 || std::any_of(begin, end, [](const PlacedPhase& placed) {
          return HasFlightOrImpact(*placed.phase);
        });
    if (is_dynamic) stretches.push_back(Stretch(begin, end));
    begin = end;
  }
  return stretches;
}

}  // namespace possibility::actions
