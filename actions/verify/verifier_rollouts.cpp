#include "actions/verify/verifier_rollouts.h"

#include <algorithm>
#include <atomic>

#include "actions/rollout/rollout_check.h"
#include "actions/verify/verdict_store.h"
#include "actions/verify/verdict_subject.h"
#include "common/run_on_threads.h"
#include "dynamics/tree/tree_kinematics.h"

namespace possibility::actions {
namespace {

/// m: drift between samples and while the last posture is held, between knots, and at edges.
constexpr double kReachMargin = 0.15;

/// Around everywhere a simulation that drifts this little may have asked for ground.
models::WorldReach ReachOf(const DynamicStretch& stretch, const models::RobotModel& robot,
                           const RolloutDrift& drift) {
  dynamics::TreeKinematics kinematics(robot);
  Eigen::AlignedBox3d box;
  double farthest = 0;  // from the root
  for (const Phase& phase : stretch.motion.phases) {
    for (const Knot& knot : phase.knots) {
      kinematics.SetPosition(knot.q);
      for (const models::ContactPatch& patch : robot.contacts) {
        for (const Eigen::Vector3d& point : patch.points) {
          const Eigen::Vector3d p = kinematics.Position(patch.link, point);
          box.extend(p);
          farthest = std::max(farthest, (p - knot.q.segment<3>(4)).norm());
        }
      }
    }
  }
  const double turned = drift.worst_orientation + robot.num_joints() * drift.worst_joint;
  const double by = kReachMargin + drift.worst_position + 2 * farthest * turned;
  box.min().array() -= by;
  box.max().array() += by;
  return {{}, box};
}

/// A simulation near its motion reads only the ground near it.
bool IsNear(const RolloutDrift& drift) {
  return drift.follows() && !drift.fell_at && drift.worst_position <= kRolloutPosition &&
         drift.worst_orientation <= kRolloutOrientation;
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

void VerifyRollouts(const VerifiedPlan& subject, const VerifierSettings& settings,
                    ViolationLog* log, VerificationReport* report) {
  const std::vector<DynamicStretch> stretches = DynamicStretches(subject.plan);
  VerdictStore* const store = settings.store;
  std::vector<StretchRollout> rollouts(stretches.size());
  std::atomic<std::size_t> next = 0;
  std::atomic<bool> cancelled = false;
  std::atomic<int> kept = 0;
  RolloutCheckSettings check;
  check.measures_torque = false;  // the plan's own are among the margins
  check.cancellation = CancellationToken([&] {
    if (settings.progress) settings.progress(1);
    if (!settings.cancellation.Proceed()) cancelled = true;
    return !cancelled;
  });
  const int threads = std::min(settings.threads, static_cast<int>(rollouts.size()));
  RunOnThreads(threads, [&] {
    for (std::size_t i = next++; i < rollouts.size() && !cancelled; i = next++) {
      const DynamicStretch& stretch = stretches[i];
      rollouts[i] = {stretch.first_segment, stretch.last_segment, {}};
      const std::string key = store ? SubjectOf(stretch, subject.robot) : std::string();
      if (const auto known =
              store ? store->rollouts.Find(key, subject.local_world) : std::nullopt) {
        rollouts[i].drift = *known;
        ++kept;
        continue;
      }
      RolloutDrift& drift = rollouts[i].drift;
      drift = RollOutSegment(stretch.motion, subject.robot, subject.ground, check);
      if (!store || cancelled || !IsNear(drift)) continue;
      store->rollouts.Add(key, ReachOf(stretch, subject.robot, drift), subject.local_world, drift);
    }
  });
  report->cancelled = cancelled;
  if (cancelled) return;
  for (const StretchRollout& rollout : rollouts) Judge(rollout, log);
  report->rollouts = std::move(rollouts);
  report->kept_rollouts = kept;
}

std::vector<Violation> RolloutViolations(const StretchRollout& rollout) {
  ViolationLog log;
  Judge(rollout, &log);
  return log.Worst();
}

}  // namespace possibility::actions
