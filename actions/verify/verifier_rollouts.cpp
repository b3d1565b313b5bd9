#include "actions/verify/verifier_rollouts.h"

#include <algorithm>
#include <atomic>

#include "actions/rollout/rollout_check.h"
#include "common/run_on_threads.h"

namespace possibility::actions {
namespace {

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
