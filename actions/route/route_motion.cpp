#include "actions/route/route_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <optional>
#include <thread>

#include "actions/gait/quasi_static_gait.h"
#include "actions/motion/phase_sequence.h"
#include "actions/route/gait_run.h"
#include "actions/route/rounded_run.h"
#include "actions/wholebody/motion_collision.h"
#include "common/cancellation_token.h"
#include "models/world/collision.h"
#include "models/world/ground_map.h"

namespace possibility::actions {
namespace {

/// Duration of the pause for a leg of zero length, s.
constexpr double kStandingTime = 0.2;

/// Motions of neighbouring legs meet within this: m, rad, m/s, rad/s.
constexpr double kContinuity = 1e-6;

/// The leg shifted so that it begins at the origin, with its heading unchanged. Motion is generated
/// there and shifted back, because tolerances must not depend on the place: 10 km from the origin,
/// rounding of doubles exceeds the tolerance of inverse kinematics.
RouteLeg SeenFromItsBeginning(RouteLeg leg) {
  leg.to.x -= leg.from.x;
  leg.to.y -= leg.from.y;
  leg.from.x = leg.from.y = leg.z = leg.z_to = 0;
  return leg;
}

std::vector<Phase> Shifted(std::vector<Phase> phases, const Eigen::Vector3d& by) {
  for (Phase& phase : phases) {
    for (Knot& knot : phase.knots) knot.q.segment<3>(4) += by;
  }
  return phases;
}

/// Stands still at the beginning of `leg`.
std::vector<Phase> Pause(const LocomotionModel& model, const RouteLeg& leg) {
  const NominalStance& stance = model.gaits[leg.gait]->stance;
  Eigen::VectorXd guess = stance.q;
  guess.segment<2>(4) = leg.from.position();
  return MotionBuilder(*model.robot)
      .Build({QuasiStaticGait(*model.robot, stance).Standing(leg.from, leg.z, kStandingTime)},
             guess);
}

/// The motion of a straight way in one gait that begins at the origin.
std::vector<Phase> GaitPhases(const LocomotionModel& model, const RouteLeg& leg,
                              const CancellationToken& cancellation) {
  const LocomotionModel::GaitEntry& gait = *model.gaits[leg.gait];
  const std::vector<PlanarPose> strides = PlanStrides(gait.gait.parameters, leg.from, leg.to);
  if (strides.size() == 1) return Pause(model, leg);
  return gait.motion->Motion(strides, MotionSettings().knot_spacing, cancellation);
}

std::vector<Phase> TransitionPhases(const LocomotionModel& model, const RouteLeg& leg) {
  const std::vector<Phase> phases =
      Placed(model.transitions[leg.transition].phases, leg.backwards ? leg.to : leg.from, leg.z);
  return leg.backwards ? Reversed(*model.robot, phases) : phases;
}

/// @throws MotionError unless the robot is at rest in the stance at this knot. `joints`: in place
/// of the stance's unless empty.
void RequireStance(const LocomotionModel& model, int gait, const PlanarPose& pose, double z,
                   const Knot& knot, const char* where, const Eigen::VectorXd& joints = {}) {
  const NominalStance& stance = model.gaits[gait]->stance;
  const Eigen::Isometry3d X_WR = stance.RootPose(pose, z);
  const auto n = model.robot->num_joints();
  const Eigen::VectorXd posture = joints.size() > 0 ? joints : stance.q.tail(n).eval();
  const Eigen::Quaterniond turn(knot.q[0], knot.q[1], knot.q[2], knot.q[3]);
  const double off = std::max({(knot.q.segment<3>(4) - X_WR.translation()).norm(),
                               turn.angularDistance(Eigen::Quaterniond(X_WR.linear())),
                               (knot.q.tail(n) - posture).lpNorm<Eigen::Infinity>()});
  if (!(off < kContinuity)) {
    throw MotionError(fmt::format("the motion {} {:.2g} (m or rad) off the stance of '{}'", where,
                                  off, stance.gait->name));
  }
  if (!(knot.v.lpNorm<Eigen::Infinity>() < kContinuity)) {
    throw MotionError(fmt::format("the motion {} in the stance of '{}' but not at rest", where,
                                  stance.gait->name));
  }
}

/// Checks what the rest of the plan relies on. The verifier checks everything else.
void RequireFit(const LocomotionModel& model, const RouteLeg& leg,
                const std::vector<Phase>& phases) {
  if (phases.empty()) throw MotionError("the motion has no phases");
  const int nq = model.robot->nq();
  for (const Phase& phase : phases) {
    if (phase.knots.size() < 2) throw MotionError("a phase of the motion has less than two knots");
    for (const Knot& knot : phase.knots) {
      if (knot.q.size() == nq && knot.v.size() == model.robot->nv()) continue;
      throw MotionError("a knot of the motion is not of the robot's sizes");
    }
  }
  if (!(std::abs(phases.front().knots.front().t) < 1e-9)) {
    throw MotionError("the motion does not begin at time 0");
  }
  RequireStance(model, StartGait(model, leg), leg.from, leg.z, phases.front().knots.front(),
                "begins");
  RequireStance(model, EndGait(model, leg), leg.to, leg.z_to, phases.back().knots.back(), "ends");
}

std::vector<Phase> PhasesOf(const LocomotionModel& model, const RouteLeg& leg,
                            const CancellationToken& cancellation) {
  if (leg.manoeuvre != nullptr) return leg.manoeuvre->Motion(LegEdge(model, leg), cancellation);
  if (leg.transition >= 0) return TransitionPhases(model, leg);
  const RouteLeg local = SeenFromItsBeginning(leg);
  return Shifted(GaitPhases(model, local, cancellation), {leg.from.x, leg.from.y, leg.z});
}

/// What GenerateRun needs, the same for all runs.
struct RunContext {
  const LocomotionModel& model;
  const models::Environment& environment;
  const Route& route;
  models::CollisionChecker checker = {*model.robot, environment};
  models::GroundMap ground = models::GroundMap(environment, model.robot->friction);
};

/// @throws MotionError unless the robot begins and ends in the route's stances.
void RequireStances(const RunContext& context, int first, const FlowEnd& end,
                    const std::vector<std::vector<Phase>>& legs) {
  const RouteLeg& from = context.route[first];
  const RouteLeg& to = context.route[first + legs.size() - 1];
  RequireStance(context.model, from.gait, from.from, from.z, legs.front().front().knots.front(),
                "begins");
  RequireStance(context.model, to.gait, to.to, to.z_to, legs.back().back().knots.back(), "ends",
                end.joints);
}

/// @throws MotionError if the robot hits something.
void RequireFree(const RunContext& context, const std::vector<std::vector<Phase>>& legs,
                 const CancellationToken& cancellation) {
  for (const std::vector<Phase>& leg : legs) {
    const std::string hit =
        FirstHit(*context.model.robot, context.environment, context.checker, leg, cancellation);
    if (!cancellation.Proceed()) throw Cancelled();
    if (!hit.empty()) throw MotionError(hit);
  }
}

/// One flow through the legs of a run, with rounded bends if there is such a motion.
std::vector<std::vector<Phase>> FreeFlow(const RunContext& context, int first, int count,
                                         const FlowEnd& end,
                                         const CancellationToken& cancellation) {
  const RunWorld world{context.environment, context.checker, context.ground};
  auto rounded = RoundedFlow(context.model, world, context.route, first, count, end, cancellation);
  if (rounded) return *std::move(rounded);
  std::vector<std::vector<Phase>> legs =
      FlowAlong(context.model, context.route, first, count,
                StraightLinesOf(context.model, context.route, first, count), end, cancellation);
  RequireFree(context, legs, cancellation);
  return legs;
}

std::vector<Phase> MotionOfLeg(const RunContext& context, int leg,
                               const CancellationToken& cancellation) {
  try {
    return GenerateLeg(context.model, context.route[leg], cancellation);
  } catch (const MotionError& error) {
    throw LegError(leg, error.what());
  }
}

/// Motions of `count` legs from `first` on, times of each from 0: one flow if there is one, else
/// that of each half. Returns whether the last leg ends like `end`; otherwise in its stance.
bool GenerateRun(const RunContext& context, int first, int count, const FlowEnd& end,
                 const CancellationToken& cancellation, std::vector<std::vector<Phase>>* motions) {
  if (count > 1 || end.joints.size() > 0) {
    try {
      std::vector<std::vector<Phase>> legs = FreeFlow(context, first, count, end, cancellation);
      RequireStances(context, first, end, legs);
      std::move(legs.begin(), legs.end(), motions->begin() + first);
      return true;
    } catch (const Cancelled&) {
      throw;
    } catch (const std::exception&) {
      // The robot rests where the halves meet.
    }
  }
  if (count == 1) {
    (*motions)[first] = MotionOfLeg(context, first, cancellation);
    return false;
  }
  GenerateRun(context, first, count / 2, {}, cancellation, motions);
  return GenerateRun(context, first + count / 2, count - count / 2, end, cancellation, motions);
}

/// A run of legs, or a run and the manoeuvre that it leads to.
struct Run {
  int first = 0;
  int count = 1;  ///< of legs, without the manoeuvre
  bool has_manoeuvre = false;
  std::optional<LegError> error;

  int length() const { return count + (has_manoeuvre ? 1 : 0); }
};

Run RunFrom(const RunContext& context, int first) {
  Run run;
  run.first = first;
  run.count = RunLength(context.model, context.route, first);
  const RouteLeg& leg = context.route[first];
  const int next = first + run.count;
  run.has_manoeuvre = leg.manoeuvre == nullptr && leg.transition < 0 &&
                      context.model.gaits[leg.gait]->motion->Flows() &&
                      next < static_cast<int>(context.route.size()) &&
                      context.route[next].manoeuvre != nullptr;
  return run;
}

/// The robot prepares for a manoeuvre on the way to it, if it can.
void GenerateWithManoeuvre(const RunContext& context, const Run& run,
                           const CancellationToken& cancellation,
                           std::vector<std::vector<Phase>>* motions) {
  const int manoeuvre = run.first + run.count;
  std::vector<Phase> motion = MotionOfLeg(context, manoeuvre, cancellation);
  const NominalStance& stance = context.model.gaits[context.route[run.first].gait]->stance;
  const std::optional<FlowEnd> ready = EndReadyFor(stance, motion);
  const bool is_ready =
      GenerateRun(context, run.first, run.count, ready.value_or(FlowEnd()), cancellation, motions);
  if (ready && is_ready) {
    motion.erase(motion.begin());
    ShiftTime(-motion.front().knots.front().t, &motion);
  }
  (*motions)[manoeuvre] = std::move(motion);
}

/// Distributes runs of legs to workers; the first failure in route order wins.
class RunQueue {
 public:
  RunQueue(const RunContext& context, const CancellationToken& cancellation,
           const std::function<void(double)>& progress)
      : context_(context),
        cancellation_(cancellation),
        progress_(progress),
        motions_(context.route.size()) {
    for (int leg = 0; leg < static_cast<int>(context.route.size()); leg += runs_.back().length()) {
      runs_.push_back(RunFrom(context_, leg));
    }
  }

  void Work() {
    const CancellationToken own([this] { return Proceed(); });
    for (size_t i = next_++; i < runs_.size() && !cancelled_; i = next_++) {
      Run& run = runs_[i];
      try {
        if (run.has_manoeuvre) {
          GenerateWithManoeuvre(context_, run, own, &motions_);
        } else {
          GenerateRun(context_, run.first, run.count, {}, own, &motions_);
        }
      } catch (const LegError& error) {
        run.error = error;
      } catch (const Cancelled&) {
        cancelled_ = true;
      }
      done_ += run.length();
    }
  }

  std::vector<std::vector<Phase>> TakeMotions() {
    if (cancelled_) throw Cancelled();
    for (const Run& run : runs_) {
      if (run.error) throw *run.error;
    }
    return std::move(motions_);
  }

 private:
  /// Reports progress as often as a leg asks: legs may take long.
  bool Proceed() const {
    const double fraction = static_cast<double>(done_) / static_cast<double>(motions_.size());
    if (progress_) progress_(fraction);
    return !cancelled_ && cancellation_.Proceed();
  }

  const RunContext& context_;
  const CancellationToken& cancellation_;
  const std::function<void(double)>& progress_;
  std::vector<std::vector<Phase>> motions_;
  std::vector<Run> runs_;
  std::atomic<size_t> next_ = 0;
  std::atomic<size_t> done_ = 0;
  std::atomic<bool> cancelled_ = false;
};

}  // namespace

std::vector<Phase> GenerateLeg(const LocomotionModel& model, const RouteLeg& leg,
                               const CancellationToken& cancellation) {
  try {
    std::vector<Phase> phases = PhasesOf(model, leg, cancellation);
    RequireFit(model, leg, phases);
    return phases;
  } catch (const MotionError&) {
    throw;
  } catch (const Cancelled&) {
    throw;
  } catch (const std::exception& error) {
    throw MotionError(fmt::format("no motion: {}", error.what()));
  }
}

std::vector<Segment> GenerateMotion(const LocomotionModel& model,
                                    const models::Environment& environment, const Route& route,
                                    int threads, const CancellationToken& cancellation,
                                    const std::function<void(double)>& progress) {
  const RunContext context{model, environment, route};
  RunQueue queue(context, cancellation, progress);
  {
    std::vector<std::jthread> workers;
    for (int i = 1; i < std::min<int>(threads, static_cast<int>(route.size())); ++i) {
      workers.emplace_back([&queue] { queue.Work(); });
    }
    queue.Work();
  }
  std::vector<std::vector<Phase>> motions = queue.TakeMotions();
  std::vector<Segment> segments;
  double time = 0;
  for (size_t i = 0; i < route.size(); ++i) {
    ShiftTime(time, &motions[i]);
    time = motions[i].back().knots.back().t;
    segments.push_back({LegName(model, route[i]), std::move(motions[i])});
  }
  return segments;
}

}  // namespace possibility::actions
