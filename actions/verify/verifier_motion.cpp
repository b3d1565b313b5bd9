#include "actions/verify/verifier_motion.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <mutex>

#include "actions/checks/collision_check.h"
#include "actions/checks/forces_check.h"
#include "actions/checks/limits_check.h"
#include "actions/evidence/derivative_bounds.h"
#include "actions/plan/interpolation.h"
#include "actions/verify/verdict_store.h"
#include "actions/verify/verdict_subject.h"
#include "common/run_on_threads.h"
#include "dynamics/tree/tree_kinematics.h"

namespace possibility::actions {
namespace {

// Largest deviations from the straight line between two samples; they determine the number of
// samples.
constexpr double kPointResolution = 1e-4;        // m, of bearing points
constexpr double kPointSpeedResolution = 5e-4;   // m/s, likewise
constexpr double kForceResolution = 0.01;        // of the weight (N; N m over 1 m), on the root
constexpr double kTorqueResolution = 0.01;       // of each joint's effort limit, but at least:
constexpr double kLeastTorqueResolution = 1e-5;  // of the weight (N; N m over 1 m)
/// With more samples than this between two knots, a few are checked first.
constexpr int kManySteps = 64;
/// Forces that need more samples than this between two knots are thousands of times the weight.
constexpr int kMostSteps = 2000;
/// m, beyond what is asked: more than all tolerances of the checks.
constexpr double kRadiusMargin = 2e-3;

/// A run of knot intervals of one phase: the unit of work of a thread. The division does not depend
/// on the number of threads.
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

/// Checks chunks with its own Simbody and Bullet systems.
class Worker {
 public:
  Worker(const VerifiedPlan& subject, double resolution)
      : subject_(&subject),
        resolution_(resolution),
        weight_(subject.robot.TotalMass() * dynamics::kGravity),
        evaluator_(subject.robot),
        collision_(subject.robot, subject.scenario.environment, evaluator_.link_radii()),
        bounds_(subject.robot) {}

  /// Returns the log of the chunk.
  const ViolationLog& Verify(const Chunk& chunk) {
    chunk_ = &chunk;
    chunk_log_ = {};
    coverage_ = {};
    reach_.setEmpty();
    Sample sample;
    for (std::size_t i = chunk.begin; i < chunk.end; ++i) VerifyInterval(i, &sample);
    return chunk_log_;
  }

  /// Of the last chunk.
  const MotionCoverage& coverage() const { return coverage_; }
  /// Around all that the last chunk's checks have asked the world about.
  models::WorldReach reach() const { return {reach_, reach_}; }

 private:
  struct Sample {
    VerifierState state;
    CollisionSnapshot collision;
  };

  /// Checks between knots i and i + 1. `sample`: the sample at knot i, unless the chunk begins
  /// there; becomes the sample at knot i + 1.
  void VerifyInterval(std::size_t i, Sample* sample) {
    const std::vector<Knot>& knots = chunk_->phase->knots;
    const Knot& k0 = knots[i];
    const Knot& k1 = knots[i + 1];
    const KnotInterpolant interpolant(k0, k1);
    const bool is_slow =
        CheckJointLimits(interpolant, subject_->robot, chunk_->segment, &chunk_log_);
    CheckJointCouplings(interpolant, subject_->robot, chunk_->segment, &chunk_log_);
    bounds_.Set(interpolant, k0, k1, contacts().points);
    const int steps = Steps(interpolant, is_slow);
    const double interval = interpolant.duration() / steps;
    Cover(interval);
    if (i == chunk_->begin) {
      *sample = Take(k0, interval);
      CheckAll(*sample, true);
    }
    for (int step = 1; step <= steps; ++step) {
      const bool at_knot = step == steps;
      const double next_interval =
          at_knot && i + 1 < chunk_->end ? std::max(interval, StepAfter(i + 1)) : interval;
      Sample next = Take(at_knot ? k1 : interpolant.At(k0.t + step * interval), next_interval);
      CheckAll(next, at_knot);
      // A motion beyond the speed limits is refused anyway, and subdivision would take too long.
      if (is_slow) Subdivide(interpolant, *sample, next);
      *sample = std::move(next);
    }
  }

  const PhaseContacts& contacts() const { return subject_->contacts[chunk_->phase_index]; }

  int StepsInTime(double duration) const {
    return std::max(1, static_cast<int>(std::ceil(duration / resolution_ - 1e-9)));
  }

  /// s, between samples after knot i, unless the motion needs more of them.
  double StepAfter(std::size_t i) const {
    const double duration = chunk_->phase->knots[i + 1].t - chunk_->phase->knots[i].t;
    return duration / StepsInTime(duration);
  }

  /// Number of equal steps between two knots. A motion already refused gets no more steps than the
  /// time resolution needs.
  int Steps(const KnotInterpolant& interpolant, bool is_slow) {
    const int in_time = StepsInTime(interpolant.duration());
    if (!is_slow || !chunk_log_.Worst().empty()) return in_time;
    const double wanted = interpolant.duration() * std::sqrt(BoundOverResolution() / 8);
    if (wanted <= std::max(in_time, kManySteps)) {
      return std::max(in_time, static_cast<int>(std::ceil(wanted)));
    }
    for (int i = 1; i < kManySteps; ++i) {
      const Knot knot =
          interpolant.At(interpolant.start() + i * interpolant.duration() / kManySteps);
      CheckAll({evaluator_.Evaluate(knot), {}}, false);
      ++coverage_.samples;
      if (!chunk_log_.Worst().empty()) return in_time;
    }
    if (wanted <= kMostSteps) return static_cast<int>(std::ceil(wanted));
    chunk_log_.Report(ViolationKind::kDynamics, {chunk_->segment, interpolant.start()},
                      "forces change too much between two knots to be bounded");
    return in_time;
  }

  /// The largest ratio of a quantity's second derivative to its resolution, 1/s^2.
  double BoundOverResolution() const {
    double ratio = std::max({bounds_.point_acceleration() / kPointResolution,
                             bounds_.point_jerk() / kPointSpeedResolution,
                             bounds_.force_change() / (kForceResolution * weight_),
                             bounds_.moment_change() / (kForceResolution * weight_)});
    for (int j = 0; j < subject_->robot.num_joints(); ++j) {
      const double wanted = std::max(kTorqueResolution * subject_->robot.joints[j].effort,
                                     kLeastTorqueResolution * weight_);
      ratio = std::max(ratio, bounds_.JointTorqueChange(j) / wanted);
    }
    return ratio;
  }

  void Cover(double interval) {
    const double factor = interval * interval / 8;
    double change = std::max(bounds_.force_change(), bounds_.moment_change());
    for (int j = 0; j < subject_->robot.num_joints(); ++j) {
      change = std::max(change, bounds_.JointTorqueChange(j));
    }
    coverage_.Add({0, interval, factor * bounds_.point_acceleration(), factor * change});
  }

  /// `interval`: s, to the neighbouring samples.
  Sample Take(const Knot& knot, double interval) {
    Sample sample;
    sample.state = evaluator_.Evaluate(knot);
    sample.collision =
        collision_.Check(sample.state, interval, {chunk_->segment, knot.t}, &chunk_log_);
    ++coverage_.samples;
    ExtendReach(sample);
    return sample;
  }

  /// Bearing points are points of links.
  void ExtendReach(const Sample& sample) {
    for (std::size_t link = 0; link < sample.state.X_WL.size(); ++link) {
      const double radius =
          evaluator_.link_radii()[link] + sample.collision.environment_threshold + kRadiusMargin;
      const Eigen::Vector3d p = sample.state.X_WL[link].translation();
      reach_.extend((p.array() - radius).matrix());
      reach_.extend((p.array() + radius).matrix());
    }
  }

  void CheckAll(const Sample& sample, bool at_knot) {
    const Instant at{chunk_->segment, sample.state.knot.t};
    CheckContacts(sample.state, contacts(), subject_->robot, subject_->ground, at, &chunk_log_);
    CheckForces(sample.state, contacts(), subject_->robot, evaluator_.dynamics(), at_knot,
                subject_->plan.version, at, &chunk_log_);
    const std::optional<Flight>& flight = subject_->flights[chunk_->phase_index];
    if (flight) {
      CheckFlight(sample.state, *flight, subject_->robot, evaluator_.dynamics(), at, &chunk_log_);
    }
  }

  /// For collisions alone: for everything else the samples are dense enough.
  void Subdivide(const KnotInterpolant& interpolant, const Sample& s0, const Sample& s1) {
    if (!collision_.NeedsSubdivision(s0.state, s0.collision, s1.state, s1.collision, bounds_)) {
      return;
    }
    const double t = (s0.state.knot.t + s1.state.knot.t) / 2;
    if (t <= s0.state.knot.t || t >= s1.state.knot.t) return;
    const Sample middle = Take(interpolant.At(t), t - s0.state.knot.t);
    Subdivide(interpolant, s0, middle);
    Subdivide(interpolant, middle, s1);
  }

  const VerifiedPlan* subject_;
  double resolution_;
  double weight_;
  StateEvaluator evaluator_;
  CollisionVerifier collision_;
  DerivativeBounds bounds_;  ///< of the current interval
  const Chunk* chunk_ = nullptr;
  ViolationLog chunk_log_;
  MotionCoverage coverage_;    ///< likewise
  Eigen::AlignedBox3d reach_;  ///< likewise
};

/// Sums over the chunks of one thread, or of all.
struct Sum {
  ViolationLog log;
  MotionCoverage coverage;
  std::int64_t kept_samples = 0;

  void Add(const Sum& other) {
    log.Merge(other.log);
    coverage.Add(other.coverage);
    kept_samples += other.kept_samples;
  }
};

/// Sums over all threads.
class Tally {
 public:
  void Add(const Sum& sum) {
    const std::lock_guard lock(mutex_);
    sum_.Add(sum);
  }

  void Fail(std::exception_ptr error) {
    const std::lock_guard lock(mutex_);
    if (!error_) error_ = error;
  }

  void Finish(ViolationLog* log, VerificationReport* report) const {
    if (error_) std::rethrow_exception(error_);
    log->Merge(sum_.log);
    report->samples = sum_.coverage.samples;
    report->kept_samples = sum_.kept_samples;
    report->resolution = sum_.coverage.time;
    report->position_resolution = sum_.coverage.position;
    report->force_resolution = sum_.coverage.force;
  }

 private:
  std::mutex mutex_;
  Sum sum_;
  std::exception_ptr error_;
};

/// Verifies chunks on one thread, except those that the store knows.
class ChunkJudge {
 public:
  ChunkJudge(const VerifiedPlan& subject, const VerifierSettings& settings)
      : subject_(subject), settings_(settings) {}

  void Judge(const Chunk& chunk) {
    const std::string key = settings_.store ? KeyOf(chunk) : std::string();
    const auto known =
        settings_.store ? settings_.store->motions.Find(key, subject_.local_world) : std::nullopt;
    if (known) {
      sum_.coverage.Add(*known);
      sum_.kept_samples += known->samples;
      return;
    }
    if (!worker_) worker_.emplace(subject_, settings_.resolution);
    const ViolationLog& log = worker_->Verify(chunk);
    sum_.log.Merge(log);
    sum_.coverage.Add(worker_->coverage());
    if (!settings_.store || !log.Worst().empty()) return;
    settings_.store->motions.Add(key, worker_->reach(), subject_.local_world, worker_->coverage());
  }

  const Sum& sum() const { return sum_; }

 private:
  std::string KeyOf(const Chunk& chunk) const {
    return SubjectOf(
        KnotRun{*chunk.phase, chunk.begin, chunk.end, subject_.contacts[chunk.phase_index],
                subject_.flights[chunk.phase_index]},
        subject_.robot, settings_.resolution, subject_.plan.version);
  }

  const VerifiedPlan& subject_;
  const VerifierSettings& settings_;
  std::optional<Worker> worker_;  ///< made when there is work: it costs as much as some samples
  Sum sum_;
};

}  // namespace

void VerifyMotion(const VerifiedPlan& subject, const VerifierSettings& settings, ViolationLog* log,
                  VerificationReport* report) {
  const std::vector<Chunk> chunks = Divide(subject.plan);
  std::atomic<std::size_t> next = 0;
  std::atomic<bool> cancelled = false;
  Tally tally;
  const auto work = [&] {
    try {
      ChunkJudge judge(subject, settings);
      for (std::size_t i = next++; i < chunks.size() && !cancelled; i = next++) {
        judge.Judge(chunks[i]);
        if (settings.progress) {
          settings.progress(static_cast<double>(i + 1) / static_cast<double>(chunks.size()));
        }
        if (!settings.cancellation.Proceed()) cancelled = true;
      }
      tally.Add(judge.sum());
    } catch (...) {
      tally.Fail(std::current_exception());
    }
  };
  RunOnThreads(settings.threads, work);
  tally.Finish(log, report);
  report->cancelled = cancelled;
}

}  // namespace possibility::actions
