#include "actions/footsteps/footstep_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "actions/footsteps/sideways_load.h"
#include "actions/motion/pattern_motion.h"
#include "actions/wholebody/motion_error.h"
#include "dynamics/tree/tree_kinematics.h"

namespace possibility::actions {
namespace {

// Durations of a biped, s; those of swings grow with lift and change of height. Of more limbs they
// are in the same proportion to the gait's time of a swing.
constexpr double kLevelSwing = 0.55;
constexpr double kHighSwing = 1.0;
constexpr double kSecondsPerMetreUp = 1;
constexpr double kDoubleSupport = 0.15;
constexpr double kHighDoubleSupport = 0.2;
constexpr double kStart = 0.8;

// Slower by this, for a step that fails and its neighbours; at most so much slower.
constexpr double kSlower = 1.25;
constexpr double kSlowest = 2;

constexpr double kKnotSpacing = 0.02;  // s
constexpr int kLeastIntervals = 4;
constexpr int kFilterPasses = 3;
constexpr int kCoarseStride = 4;

/// Of a rough motion: spacing, s, and how far its distances may be off, m.
constexpr double kRoughGrid = 0.06;
constexpr double kRoughness = 0.3e-3;

/// Distances of links from each other, m: wanted, and enough. High steps bring thighs close to the
/// pelvis.
constexpr double kSelfDistance = 0.003;
constexpr double kLeastSelfDistance = 0.001;

/// A knee that bears high steps is spared by a zero moment point so far ahead, m.
constexpr double kZmpAhead = 0.03;

/// The legs are less astride if the root need not come so far over the foot that bears: share of
/// the gait's margin of the zero moment point.
constexpr double kLeastMargin = 0.67;

/// A hip that bears holds the trunk up sideways. Where that takes more than this share of its
/// torque (SidewaysLoad), it is spared by a trunk that rolls over it, rad. So is the range of a hip
/// that swings far aside.
constexpr double kHeavySideways = 0.8;
constexpr double kSway = 0.08;
/// It rolls from one side to the other while both feet bear, which takes so many times as long.
constexpr double kSwayingSupport = 2;

/// Of every bearing point, as a share of the weight. On steep ground it costs friction: what a
/// point bears at least has no part in balance.
constexpr double kLeastLoad = 0.01;

/// The root as high as the legs reach: more than that above the stance, as a share of its height.
constexpr double kTall = 0.21;

bool IsHigh(const Footstep& step) { return step.lift > 0 || step.ChangeOfHeight() > 0; }

double SwingDuration(const Footstep& step) {
  if (!IsHigh(step)) return kLevelSwing;
  return kHighSwing + kSecondsPerMetreUp * (step.lift + step.ChangeOfHeight());
}

/// All limbs bear after a step: how long, before the next one.
double DoubleSupport(const std::vector<Footstep>& steps, std::size_t step) {
  const bool is_high = IsHigh(steps[step]) || (step + 1 < steps.size() && IsHigh(steps[step + 1]));
  return is_high ? kHighDoubleSupport : kDoubleSupport;
}

/// A joint beyond its range in a swing is a matter of the posture at the nearer end of the step.
FootstepError::Part PartOf(const MotionError& error) {
  if (error.limit() != MotionError::Limit::kJointRange ||
      !FootstepMotion::SwingsIn(error.phase())) {
    return FootstepError::Part::kStep;
  }
  return error.share() < 0.5 ? FootstepError::Part::kFrom : FootstepError::Part::kTo;
}

}  // namespace

FootstepMotion::FootstepMotion(const models::RobotModel& robot, const NominalStance& stance)
    : robot_(&robot),
      stance_(&stance),
      self_clearance_(robot, {stance.q}),
      has_two_limbs_(stance.gait->limbs.size() == 2),
      sideways_load_(has_two_limbs_ ? SidewaysLoad(robot, stance) : 0),
      tempo_(has_two_limbs_ ? 1 : stance.gait->parameters.swing_time / kLevelSwing) {}

double FootstepMotion::ExpectedDuration(const std::vector<Footstep>& steps) const {
  double duration = 0;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    duration += SwingDuration(steps[i]);
    if (i + 1 < steps.size()) duration += DoubleSupport(steps, i);
  }
  return 2 * kStart + tempo_ * duration;
}

double FootstepMotion::LeastStepTime() const { return tempo_ * (kLevelSwing + kDoubleSupport); }

int FootstepMotion::StepOfPhase(int phase, int steps) {
  // Phases alternate: all limbs bear, one swings, ...
  return std::clamp((phase - 1) / 2, 0, steps - 1);
}

models::ContactSchedule FootstepMotion::ScheduleOf(const std::vector<Pace>& paces,
                                                   const Foothold& start,
                                                   const std::vector<Footstep>& steps) const {
  models::ContactSchedule schedule;
  models::ContactInterval standing;
  for (std::size_t limb = 0; limb < stance_->gait->limbs.size(); ++limb) {
    schedule.contacts.push_back(robot_->contacts[stance_->gait->limbs[limb].contact].name);
    standing.bearing.emplace_back(PatchPoseOf(*stance_, static_cast<int>(limb), start));
  }
  standing.duration = kStart;
  schedule.intervals.push_back(standing);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    models::ContactInterval swing = standing;
    swing.bearing[steps[i].limb].reset();
    swing.duration = tempo_ * paces[i].slowness * SwingDuration(steps[i]);
    schedule.intervals.push_back(std::move(swing));
    standing.bearing[steps[i].limb] = PatchPoseOf(*stance_, steps[i].limb, steps[i].to);
    const bool rolls = paces[i].sway != 0 || (i + 1 < steps.size() && paces[i + 1].sway != 0);
    standing.duration =
        tempo_ * paces[i].slowness * (rolls ? kSwayingSupport : 1) * DoubleSupport(steps, i);
    schedule.intervals.push_back(standing);
  }
  schedule.intervals.back().duration = kStart;
  return schedule;
}

void FootstepMotion::RequireSelfClearance(const std::vector<Phase>& motion, double distance,
                                          int steps) const {
  dynamics::TreeKinematics kinematics(*robot_);
  for (std::size_t i = 0; i < motion.size(); ++i) {
    for (const Knot& knot : motion[i].knots) {
      kinematics.SetPosition(knot.q);
      const auto faults = self_clearance_.Faults(kinematics.X_WL(), distance);
      if (faults.empty()) continue;
      const auto& [pair, required] = faults.front();
      throw FootstepError(fmt::format("{} is {:.4f} m from {} at {:.2f} s, expected {:.4f}",
                                      robot_->links[pair.link].name, pair.distance,
                                      robot_->links[pair.other].name, knot.t, required),
                          StepOfPhase(static_cast<int>(i), steps));
    }
  }
}

std::vector<MotionPhase> FootstepMotion::PhasesOf(const std::vector<Pace>& paces,
                                                  const Style& style, const Accuracy& accuracy,
                                                  const Foothold& start,
                                                  const std::vector<Footstep>& steps,
                                                  const CancellationToken& cancellation) const {
  PatternSettings pattern;
  pattern.clearance = stance_->gait->parameters.clearance;
  pattern.zmp_margin = style.zmp_margin * stance_->gait->parameters.com_margin;
  pattern.keeps_reach = true;
  pattern.rise = style.rise;
  pattern.lean = style.lean;
  pattern.zmp_ahead = style.zmp_ahead;
  pattern.rise_time = kStart;
  pattern.height_spacing = style.spacing;
  pattern.grid = accuracy.grid;
  pattern.least_steps = accuracy.least_steps;
  pattern.filter_passes = accuracy.filter_passes;
  pattern.coarse_stride = kCoarseStride;
  pattern.lifts.push_back(0);
  pattern.sways.push_back(0);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    pattern.lifts.insert(pattern.lifts.end(), {steps[i].lift, 0});
    pattern.sways.insert(pattern.sways.end(), {paces[i].sway, 0});
  }
  std::vector<MotionPhase> phases =
      PatternPhases(*robot_, *stance_, ScheduleOf(paces, start, steps), pattern, cancellation);
  SetFriction(start, steps, &phases);
  return phases;
}

void FootstepMotion::SetFriction(const Foothold& start, const std::vector<Footstep>& steps,
                                 std::vector<MotionPhase>* phases) const {
  std::vector<double> by_limb(stance_->gait->limbs.size(), start.friction);
  for (std::size_t i = 0; i < phases->size(); ++i) {
    const bool swings = SwingsIn(static_cast<int>(i));
    const int moving = i > 0 ? steps[(i - 1) / 2].limb : -1;
    if (i > 0 && !swings) by_limb[moving] = steps[(i - 1) / 2].to.friction;
    for (int limb = 0; limb < static_cast<int>(by_limb.size()); ++limb) {
      if (swings && limb == moving) continue;
      (*phases)[i].friction.push_back(std::min(robot_->friction, by_limb[limb]));
    }
  }
}

Eigen::VectorXd FootstepMotion::GuessAt(const Foothold& start) const {
  Eigen::VectorXd guess = stance_->q;
  guess.segment<2>(4) = start.stance.position();
  guess[6] += start.z;
  return guess;
}

std::vector<Phase> FootstepMotion::RoughMotion(const Style& style, const Foothold& start,
                                               const std::vector<Footstep>& steps,
                                               const CancellationToken& cancellation) const {
  std::vector<Phase> motion;
  try {
    const auto phases = PhasesOf(std::vector<Pace>(steps.size(), Pace{1, style.sway}), style,
                                 {.grid = kRoughGrid}, start, steps, cancellation);
    WholeBodySolver solver(*robot_);
    Eigen::VectorXd guess = GuessAt(start);
    double begin = 0;
    for (const MotionPhase& phase : phases) {
      cancellation.ThrowIfCancelled();
      motion.emplace_back();
      const int intervals = NumIntervals(phase.duration, kRoughGrid, 1);
      for (int i = 0; i <= intervals; ++i) {
        const double t = phase.duration * i / intervals;
        const WholeBodyState state = solver.Solve(phase.task(t), guess);
        Knot knot;
        knot.t = begin + t;
        knot.q = state.q;
        motion.back().knots.push_back(std::move(knot));
        guess = i < intervals ? GuessAfter(state, phase.duration / intervals) : state.q;
      }
      begin += phase.duration;
    }
  } catch (const MotionError&) {
    return {};
  }
  return motion;
}

std::vector<Phase> FootstepMotion::BuildAt(const std::vector<Pace>& paces, const Style& style,
                                           const Foothold& start,
                                           const std::vector<Footstep>& steps,
                                           const CancellationToken& cancellation) const {
  MotionSettings settings;
  settings.knot_spacing = kKnotSpacing;
  settings.torque_margin = style.torque_margin;
  settings.normal_reserve = style.least_load;
  settings.minimum_intervals = kLeastIntervals;
  settings.tests_between_knots = true;
  std::vector<Phase> motion =
      MotionBuilder(*robot_, settings)
          .Build(PhasesOf(paces, style, {kKnotSpacing, kLeastIntervals, kFilterPasses}, start,
                          steps, cancellation),
                 GuessAt(start), cancellation);
  RequireSelfClearance(motion, style.self_distance, static_cast<int>(steps.size()));
  return motion;
}

/// A slower motion has much the same postures. Other styles save torque and friction at no cost of
/// time, so they are tried first.
bool FootstepMotion::SpeedMatters(const Style& style, MotionError::Limit limit) {
  return limit == MotionError::Limit::kAny ||
         (limit != MotionError::Limit::kJointRange && style.is_patient);
}

/// What is short of friction needs all that bearing points may hold. Swaying spares hips.
bool FootstepMotion::MayHelp(const Style& style, MotionError::Limit limit) {
  if (style.sway != 0) return limit == MotionError::Limit::kTorque;
  return limit != MotionError::Limit::kFriction ||
         (style.least_load < kLeastLoad && style.zmp_ahead == 0);
}

bool FootstepMotion::Ease(const MotionError& error, const Style& style, int step,
                          std::vector<Pace>* paces) {
  if (error.limit() == MotionError::Limit::kJointRange) {
    return std::exchange((*paces)[step].sway, kSway) != kSway;
  }
  if (!SpeedMatters(style, error.limit())) return false;
  if ((*paces)[step].slowness * kSlower > kSlowest) return false;
  const int last = static_cast<int>(paces->size()) - 1;
  for (int i = std::max(0, step - 1); i <= std::min(step + 1, last); ++i) {
    (*paces)[i].slowness = std::min(kSlowest, (*paces)[i].slowness * kSlower);
  }
  return true;
}

std::vector<Phase> FootstepMotion::BuildIn(const Style& style, const Foothold& start,
                                           const std::vector<Footstep>& steps,
                                           const CancellationToken& cancellation,
                                           const RoughTest& require_rough) const {
  const int count = static_cast<int>(steps.size());
  std::vector<Pace> paces(steps.size(), Pace{1, style.sway});
  const std::vector<Phase> rough = RoughMotion(style, start, steps, cancellation);
  RequireSelfClearance(rough, style.self_distance - kRoughness, count);
  if (require_rough) require_rough(rough);
  for (;;) {
    try {
      return BuildAt(paces, style, start, steps, cancellation);
    } catch (const FootstepError&) {
      throw;  // no question of speed
    } catch (const MotionError& error) {
      if (error.phase() < 0) throw FootstepError(error.what(), -1);
      const int step = StepOfPhase(error.phase(), count);
      if (!Ease(error, style, step, &paces)) {
        throw FootstepError(error.what(), step, FootstepError::Hit::kNone, PartOf(error),
                            error.limit());
      }
    }
  }
}

/// At the origin, and carried back: far from it, rounding exceeds the tolerance of inverse
/// kinematics.
std::vector<Phase> FootstepMotion::Build(const Foothold& start, const std::vector<Footstep>& steps,
                                         const CancellationToken& cancellation, int* style,
                                         double most_torque, const RoughTest& require_rough) const {
  int first = 0;
  const Eigen::Vector3d origin(start.stance.x, start.stance.y, start.z);
  const auto moved = [&origin](Foothold place) {
    place.stance.x -= origin.x();
    place.stance.y -= origin.y();
    place.z -= origin.z();
    place.offset -= place.normal.dot(origin);
    return place;
  };
  std::vector<Footstep> near = steps;
  for (Footstep& step : near) {
    step.from = moved(step.from);
    step.to = moved(step.to);
  }
  const auto carried_back = [&origin](std::vector<Phase> motion) {
    for (Phase& phase : motion) {
      for (Knot& knot : phase.knots) knot.q.segment<3>(4) += origin;
    }
    return motion;
  };
  RoughTest require;
  if (require_rough) {
    require = [&](const std::vector<Phase>& rough) { require_rough(carried_back(rough)); };
  }
  return carried_back(BuildAtOrigin(moved(start), near, most_torque, cancellation,
                                    style ? style : &first, require));
}

std::vector<FootstepMotion::Style> FootstepMotion::Styles() const {
  const double tall = kTall * stance_->gait->posture.root_height;
  const double spared = kLeastLoad / 4;
  if (!has_two_limbs_) {
    return {{0, 0, 0.16, 0.95, kSelfDistance, kLeastLoad, 0, 1, 0, false},
            {0, 0, 0.14, 0.99, kLeastSelfDistance, spared, 0, kLeastMargin, 0}};
  }
  std::vector<Style> styles = {
      {tall, 0, 0.16, 0.95, kSelfDistance, kLeastLoad, 0, 1, 0, false},
      {tall, -0.1, 0.16, 0.95, kSelfDistance, kLeastLoad, kZmpAhead / 2, 1, 0, false},
      {tall, -0.15, 0.14, 0.99, kLeastSelfDistance, spared, kZmpAhead, 1, 0},
      {tall, -0.15, 0.14, 0.99, kLeastSelfDistance, spared, 0, kLeastMargin, 0}};
  if (sideways_load_ > kHeavySideways) {
    const Style swaying = {tall, 0, 0.16, 0.99, kSelfDistance, kLeastLoad, 0, 1, kSway};
    styles.insert(styles.begin() + 2, swaying);
  }
  return styles;
}

std::vector<Phase> FootstepMotion::BuildAtOrigin(const Foothold& start,
                                                 const std::vector<Footstep>& steps,
                                                 double most_torque,
                                                 const CancellationToken& cancellation, int* first,
                                                 const RoughTest& require_rough) const {
  std::vector<Style> styles = Styles();
  for (Style& style : styles) {
    if (style.torque_margin <= most_torque) continue;
    style.torque_margin = most_torque;
    style.is_patient = false;
  }
  FootstepError fault("no steps", -1);
  bool sways = false;  // in the style of that fault
  for (int i = *first; i < static_cast<int>(styles.size()); ++i) {
    if (!MayHelp(styles[i], fault.limit())) continue;
    try {
      std::vector<Phase> motion = BuildIn(styles[i], start, steps, cancellation, require_rough);
      *first = i;
      return motion;
    } catch (const FootstepError& error) {
      if (error.is_hit()) {
        *first = i;
        throw;
      }
      // Of a robot whose hips are spared by swaying, other styles fail at the first step.
      const bool came_less_far = sways && error.step() < fault.step();
      if (fault.step() < 0 || (error.step() >= 0 && !came_less_far)) {
        fault = error;
        sways = styles[i].sway != 0;
      }
    }
  }
  throw FootstepError(fault);
}

}  // namespace possibility::actions
