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

/// What has been checked, and at which resolution.
struct Coverage {
  std::int64_t samples = 0;
  double time = 0;      ///< s, between samples
  double position = 0;  ///< m, of bearing points off the line between samples
  double force = 0;     ///< N, or N m over 1 m, likewise

  void Add(const Coverage& other) {
    samples += other.samples;
    time = std::max(time, other.time);
    position = std::max(position, other.position);
    force = std::max(force, other.force);
  }
};

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

  void Verify(const Chunk& chunk) {
    chunk_ = &chunk;
    chunk_log_ = {};
    Sample sample;
    for (std::size_t i = chunk.begin; i < chunk.end; ++i) VerifyInterval(i, &sample);
    log_.Merge(chunk_log_);
  }

  const ViolationLog& log() const { return log_; }
  const Coverage& coverage() const { return coverage_; }

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
    return sample;
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
  ViolationLog log_;
  Coverage coverage_;
};

/// Sums over all threads.
class Tally {
 public:
  void Add(const Worker& worker) {
    const std::lock_guard lock(mutex_);
    log_.Merge(worker.log());
    coverage_.Add(worker.coverage());
  }

  void Fail(std::exception_ptr error) {
    const std::lock_guard lock(mutex_);
    if (!error_) error_ = error;
  }

  void Finish(ViolationLog* log, VerificationReport* report) const {
    if (error_) std::rethrow_exception(error_);
    log->Merge(log_);
    report->samples = coverage_.samples;
    report->resolution = coverage_.time;
    report->position_resolution = coverage_.position;
    report->force_resolution = coverage_.force;
  }

 private:
  std::mutex mutex_;
  ViolationLog log_;
  Coverage coverage_;
  std::exception_ptr error_;
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
      Worker worker(subject, settings.resolution);
      for (std::size_t i = next++; i < chunks.size() && !cancelled; i = next++) {
        worker.Verify(chunks[i]);
        if (settings.progress) {
          settings.progress(static_cast<double>(i + 1) / static_cast<double>(chunks.size()));
        }
        if (!settings.cancellation.Proceed()) cancelled = true;
      }
      tally.Add(worker);
    } catch (...) {
      tally.Fail(std::current_exception());
    }
  };
  RunOnThreads(settings.threads, work);
  tally.Finish(log, report);
  report->cancelled = cancelled;
}

}  // namespace possibility::actions
