#include "actions/verify/verifier_rollouts.h"

#include <algorithm>
#include <atomic>

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

void Judge(const StretchRollout& rollout, ViolationLog* log) {
  const RolloutDrift& drift = rollout.drift;
  const Instant at{rollout.segment, drift.end};
  if (!drift.failure.empty()) {
    log->Report(ViolationKind::kRollout, at, "simulation " + drift.failure);
    return;
  }
  // The limits are tolerances about zero, so that the log can compare how far they are exceeded.
  log->RequireAtMost(ViolationKind::kRollout, at, drift.end_position, 0, kRolloutPosition, "m",
                     [] { return std::string("root position at the end of the simulation"); });
  log->RequireAtMost(ViolationKind::kRollout, at, drift.end_orientation, 0, kRolloutOrientation,
                     "rad",
                     [] { return std::string("root orientation at the end of the simulation"); });
  if (!drift.ends_at_rest) return;
  log->RequireAtMost(ViolationKind::kRollout, at, drift.end_speed, 0, kRolloutSpeed, "m/s or rad/s",
                     [] { return std::string("root speed at the end of the simulation"); });
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

void VerifyRollouts(const VerifiedPlan& subject, const VerifierSettings& settings,
                    ViolationLog* log, VerificationReport* report) {
  const std::vector<DynamicStretch> stretches = DynamicStretches(subject.plan);
  std::vector<StretchRollout> rollouts(stretches.size());
  std::atomic<std::size_t> next = 0;
  std::atomic<bool> cancelled = false;
  RolloutCheckSettings check;
  check.cancellation = CancellationToken([&] {
    if (settings.progress) settings.progress(1);
    if (!settings.cancellation.Proceed()) cancelled = true;
    return !cancelled;
  });
  const int threads = std::min(settings.threads, static_cast<int>(rollouts.size()));
  RunOnThreads(threads, [&] {
    for (std::size_t i = next++; i < rollouts.size() && !cancelled; i = next++) {
      const DynamicStretch& stretch = stretches[i];
      rollouts[i] = {stretch.first_segment, stretch.last_segment,
                     RollOutSegment(stretch.motion, subject.robot, subject.ground, check)};
    }
  });
  report->cancelled = cancelled;
  if (cancelled) return;
  for (const StretchRollout& rollout : rollouts) Judge(rollout, log);
  report->rollouts = std::move(rollouts);
}

}  // namespace possibility::actions
