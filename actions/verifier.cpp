#include "actions/verifier.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <exception>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <thread>

#include "actions/interpolation.h"
#include "actions/verifier_collision.h"
#include "actions/verifier_contacts.h"
#include "actions/verifier_flight.h"
#include "actions/verifier_forces.h"
#include "actions/verifier_impact.h"
#include "actions/verifier_limits.h"
#include "actions/verifier_problem.h"
#include "actions/verifier_structure.h"
#include "models/ground_map.h"

namespace possibility::actions {
namespace {

/// What all threads read.
struct Subject {
  const Plan& plan;
  const models::RobotModel& robot;
  const models::Scenario& scenario;
  models::GroundMap ground;
  std::vector<PhaseContacts> contacts;         ///< by phase, over all segments
  std::vector<std::optional<Flight>> flights;  ///< likewise
  double resolution;
};

/// A run of knot intervals of one phase: what a thread takes at a time. The division does not
/// depend on the number of threads.
struct Chunk {
  int segment = 0;
  const Phase* phase = nullptr;
  std::size_t phase_index = 0;  ///< over all segments
  std::size_t begin = 0;        ///< first knot
  std::size_t end = 0;          ///< last knot
};

constexpr std::size_t kIntervalsPerChunk = 16;

std::vector<Chunk> Divide(const Plan& plan) {
  std::vector<Chunk> chunks;
  std::size_t phase_index = 0;
  for (std::size_t s = 0; s < plan.segments.size(); ++s) {
    for (const Phase& phase : plan.segments[s].phases) {
      const std::size_t last = phase.knots.size() - 1;
      for (std::size_t begin = 0; begin < last; begin += kIntervalsPerChunk) {
        chunks.push_back({static_cast<int>(s), &phase, phase_index, begin,
                          std::min(begin + kIntervalsPerChunk, last)});
      }
      ++phase_index;
    }
  }
  return chunks;
}

/// Looks at the samples of chunks, with Simbody and Bullet systems of its own.
class Worker {
 public:
  explicit Worker(const Subject& subject)
      : subject_(&subject),
        evaluator_(subject.robot),
        collision_(subject.robot, subject.scenario.environment, evaluator_.link_radii()) {}

  void Verify(const Chunk& chunk) {
    Sample previous;
    for (std::size_t i = chunk.begin; i < chunk.end; ++i) {
      const Knot& k0 = chunk.phase->knots[i];
      const Knot& k1 = chunk.phase->knots[i + 1];
      const KnotInterpolant interpolant(k0, k1);
      const double gap = k1.t - k0.t;
      const int steps = std::max(1, static_cast<int>(std::ceil(gap / subject_->resolution - 1e-9)));
      const double interval = gap / steps;
      longest_interval_ = std::max(longest_interval_, interval);
      previous = Take(chunk, k0, interval);
      CheckAll(chunk, previous, true);
      for (int step = 1; step <= steps; ++step) {
        const Knot knot = step < steps ? interpolant.At(k0.t + step * interval) : k1;
        Sample next = Take(chunk, knot, interval);
        // The next interval begins by looking at the same knot.
        if (step < steps || i + 1 == chunk.end) CheckAll(chunk, next, step == steps);
        Subdivide(chunk, interpolant, previous, next);
        previous = std::move(next);
      }
    }
  }

  const ViolationLog& log() const { return log_; }
  std::int64_t samples() const { return samples_; }
  double longest_interval() const { return longest_interval_; }

 private:
  struct Sample {
    VerifierState state;
    CollisionSnapshot collision;
  };

  /// `interval`: s, to the neighbouring samples.
  Sample Take(const Chunk& chunk, const Knot& knot, double interval) {
    Sample sample;
    sample.state = evaluator_.Evaluate(knot);
    sample.collision = collision_.Check(sample.state, interval, {chunk.segment, knot.t}, &log_);
    ++samples_;
    return sample;
  }

  void CheckAll(const Chunk& chunk, const Sample& sample, bool at_knot) {
    const Instant at{chunk.segment, sample.state.knot.t};
    const PhaseContacts& contacts = subject_->contacts[chunk.phase_index];
    CheckJointLimits(sample.state.knot, subject_->robot, at, &log_);
    CheckJointCouplings(sample.state.knot, subject_->robot, at, &log_);
    CheckContacts(sample.state, contacts, subject_->robot, subject_->ground, at, &log_);
    CheckForces(sample.state, contacts, subject_->robot, evaluator_.dynamics(), at_knot, at, &log_);
    const std::optional<Flight>& flight = subject_->flights[chunk.phase_index];
    if (flight) {
      CheckFlight(sample.state, *flight, subject_->robot, evaluator_.dynamics(), at, &log_);
    }
  }

  /// Collision only: everything else is smooth on the scale of the resolution. A motion beyond
  /// the speed limits is refused anyway, and would take forever.
  void Subdivide(const Chunk& chunk, const KnotInterpolant& interpolant, const Sample& s0,
                 const Sample& s1) {
    if (!IsWithinSpeedLimits(s0.state.knot, subject_->robot) ||
        !IsWithinSpeedLimits(s1.state.knot, subject_->robot)) {
      return;
    }
    if (!collision_.NeedsSubdivision(s0.state, s0.collision, s1.state, s1.collision)) return;
    const double t = (s0.state.knot.t + s1.state.knot.t) / 2;
    if (t <= s0.state.knot.t || t >= s1.state.knot.t) return;
    const Sample middle = Take(chunk, interpolant.At(t), t - s0.state.knot.t);
    Subdivide(chunk, interpolant, s0, middle);
    Subdivide(chunk, interpolant, middle, s1);
  }

  const Subject* subject_;
  StateEvaluator evaluator_;
  CollisionVerifier collision_;
  ViolationLog log_;
  std::int64_t samples_ = 0;
  double longest_interval_ = 0;
};

/// What the threads add up.
class Tally {
 public:
  void Add(const Worker& worker) {
    const std::lock_guard lock(mutex_);
    log_.Merge(worker.log());
    samples_ += worker.samples();
    longest_interval_ = std::max(longest_interval_, worker.longest_interval());
  }

  void Fail(std::exception_ptr error) {
    const std::lock_guard lock(mutex_);
    if (!error_) error_ = error;
  }

  void Finish(ViolationLog* log, VerificationReport* report) const {
    if (error_) std::rethrow_exception(error_);
    log->Merge(log_);
    report->samples = samples_;
    report->resolution = longest_interval_;
  }

 private:
  std::mutex mutex_;
  ViolationLog log_;
  std::int64_t samples_ = 0;
  double longest_interval_ = 0;
  std::exception_ptr error_;
};

/// Runs `work` on as many threads as wanted, this one included.
void RunOnThreads(int threads, const std::function<void()>& work) {
  std::vector<std::jthread> others;
  for (int i = 1; i < threads; ++i) others.emplace_back(work);
  work();
}

void VerifyMotion(const Subject& subject, const VerifierSettings& settings, ViolationLog* log,
                  VerificationReport* report) {
  const std::vector<Chunk> chunks = Divide(subject.plan);
  std::atomic<std::size_t> next = 0;
  std::atomic<bool> abandoned = false;
  Tally tally;
  const auto work = [&] {
    try {
      Worker worker(subject);
      for (std::size_t i = next++; i < chunks.size() && !abandoned; i = next++) {
        worker.Verify(chunks[i]);
        if (settings.keep_going &&
            !settings.keep_going(static_cast<double>(i + 1) / static_cast<double>(chunks.size()))) {
          abandoned = true;
        }
      }
      tally.Add(worker);
    } catch (...) {
      tally.Fail(std::current_exception());
    }
  };
  RunOnThreads(settings.threads, work);
  tally.Finish(log, report);
  report->abandoned = abandoned;
}

void JudgeRollout(const SegmentRollout& rollout, ViolationLog* log) {
  const RolloutDrift& drift = rollout.drift;
  const Instant at{rollout.segment, drift.end};
  if (!drift.failure.empty()) {
    log->Report(ViolationKind::kRollout, at, "simulation " + drift.failure);
    return;
  }
  // The limits are tolerances about zero, so that the log can say which is exceeded most.
  log->RequireAtMost(ViolationKind::kRollout, at, drift.end_position, 0, kRolloutPosition, "m",
                     [] { return std::string("root position at the end of the simulation"); });
  log->RequireAtMost(ViolationKind::kRollout, at, drift.end_orientation, 0, kRolloutOrientation,
                     "rad",
                     [] { return std::string("root orientation at the end of the simulation"); });
  if (!drift.ends_at_rest) return;
  log->RequireAtMost(ViolationKind::kRollout, at, drift.end_speed, 0, kRolloutSpeed, "m/s or rad/s",
                     [] { return std::string("root speed at the end of the simulation"); });
}

void VerifyRollouts(const Subject& subject, const VerifierSettings& settings, ViolationLog* log,
                    VerificationReport* report) {
  std::vector<SegmentRollout> rollouts;
  for (std::size_t s = 0; s < subject.plan.segments.size(); ++s) {
    if (IsDynamic(subject.plan.segments[s])) rollouts.push_back({static_cast<int>(s), {}});
  }
  std::atomic<std::size_t> next = 0;
  std::atomic<bool> abandoned = false;
  RolloutCheckSettings check;
  check.stop = [&] {
    if (settings.keep_going && !settings.keep_going(1)) abandoned = true;
    return abandoned.load();
  };
  const int threads = std::min(settings.threads, static_cast<int>(rollouts.size()));
  RunOnThreads(threads, [&] {
    for (std::size_t i = next++; i < rollouts.size() && !abandoned; i = next++) {
      const Segment& segment = subject.plan.segments[rollouts[i].segment];
      rollouts[i].drift = RollOutSegment(segment, subject.robot, subject.ground, check);
    }
  });
  report->abandoned = abandoned;
  if (abandoned) return;
  for (const SegmentRollout& rollout : rollouts) JudgeRollout(rollout, log);
  report->rollouts = std::move(rollouts);
}

void VerifyAll(const Plan& plan, const models::RobotModel& robot, const models::Scenario& scenario,
               const VerifierSettings& settings, ViolationLog* log, VerificationReport* report) {
  CheckFiles(plan, robot, scenario, log);
  if (!CheckStructure(plan, robot, log)) return;
  CheckActions(plan, robot, scenario, log);
  CheckBounds(plan, scenario, log);
  CheckContinuity(plan, robot, log);
  StateEvaluator evaluator(robot);
  CheckEnds(plan, robot, scenario, &evaluator, log);
  const Subject subject{plan,
                        robot,
                        scenario,
                        models::GroundMap(scenario.environment),
                        FollowContacts(plan, robot, &evaluator),
                        FollowFlights(plan, &evaluator),
                        settings.resolution};
  CheckImpacts(plan, robot, subject.contacts, &evaluator, log);
  VerifyMotion(subject, settings, log, report);
  if (settings.simulates && log->Worst().empty() && !report->abandoned) {
    VerifyRollouts(subject, settings, log, report);
  }
}

}  // namespace

std::string ToString(ViolationKind kind) {
  switch (kind) {
    case ViolationKind::kFileMismatch:
      return "file_mismatch";
    case ViolationKind::kStructure:
      return "structure";
    case ViolationKind::kAction:
      return "action";
    case ViolationKind::kStart:
      return "start";
    case ViolationKind::kGoal:
      return "goal";
    case ViolationKind::kBounds:
      return "bounds";
    case ViolationKind::kPositionContinuity:
      return "position_continuity";
    case ViolationKind::kVelocityContinuity:
      return "velocity_continuity";
    case ViolationKind::kImpact:
      return "impact";
    case ViolationKind::kJointPosition:
      return "joint_position";
    case ViolationKind::kJointSpeed:
      return "joint_speed";
    case ViolationKind::kJointTorque:
      return "joint_torque";
    case ViolationKind::kJointCoupling:
      return "joint_coupling";
    case ViolationKind::kContactMotion:
      return "contact_motion";
    case ViolationKind::kContactGround:
      return "contact_ground";
    case ViolationKind::kPenetration:
      return "penetration";
    case ViolationKind::kSelfCollision:
      return "self_collision";
    case ViolationKind::kDynamics:
      return "dynamics";
    case ViolationKind::kFriction:
      return "friction";
    case ViolationKind::kFlight:
      return "flight";
    case ViolationKind::kRollout:
      return "rollout";
  }
  throw std::invalid_argument("unknown kind of violation");
}

VerificationReport Verify(const Plan& plan, const models::RobotModel& robot,
                          const models::Scenario& scenario, const VerifierSettings& settings) {
  if (!(settings.resolution > 0) || settings.threads < 1) {
    throw std::invalid_argument("the verifier needs a positive resolution and number of threads");
  }
  const auto start = std::chrono::steady_clock::now();
  VerificationReport report;
  report.robot_file = robot.file;
  report.scenario_file = scenario.file;
  ViolationLog log;
  VerifyAll(plan, robot, scenario, settings, &log, &report);
  report.violations = log.Worst();
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return report;
}

}  // namespace possibility::actions
