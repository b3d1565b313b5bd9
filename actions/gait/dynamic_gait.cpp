#include "actions/gait/dynamic_gait.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "models/world/collision.h"

namespace possibility::actions {
namespace {

/// Knots of dynamic motion: at most this far apart, s, and at least this many intervals in a phase.
constexpr double kKnotSpacing = 0.03;
constexpr int kLeastIntervals = 4;

/// Fitted paces leave this share of joint speeds and torques for bends and unequal steps.
constexpr double kFitMargin = 0.92;

/// Family of paces: lengths of steps and durations of swings and double supports, in multiples of
/// quasi-static strides' bounds and swing time.
constexpr double kLengths[] = {1.4, 1.2, 1.0, 0.8};
constexpr double kSwings[] = {0.6, 0.7, 0.8, 0.9, 1.0};
constexpr double kDoubleSupport = 0.12;
constexpr double kStart = 0.7;  // start and stop
/// Sideways and turning steps, in multiples of strides; one limb closes up to the other.
constexpr double kAside[] = {3, 2.5, 2, 1.5, 1};

/// Steps of the ways that a pace is tried on, and their least distance between links, m.
constexpr int kFitSteps = 4;
constexpr double kFitClearance = 0.001;

/// Beside the quickest pace, the quickest below this share of its speed is kept.
constexpr double kSlowPace = 0.6;

/// Family of paces of a gait, quickest first.
std::vector<Pace> Candidates(const models::GaitParameters& parameters) {
  std::vector<Pace> paces;
  for (const double length : kLengths) {
    for (const double swing : kSwings) {
      Pace pace;
      pace.bounds = {length * parameters.forward, parameters.lateral, parameters.turn};
      pace.timing.swing = swing * parameters.swing_time;
      pace.timing.swing_length = pace.bounds.forward;
      pace.timing.double_support = kDoubleSupport * parameters.swing_time;
      pace.timing.start = kStart * parameters.swing_time;
      paces.push_back(pace);
    }
  }
  std::stable_sort(paces.begin(), paces.end(),
                   [](const Pace& a, const Pace& b) { return a.speed() > b.speed(); });
  return paces;
}

/// Ways differ if a stride moves or turns the stance by more, m and rad.
constexpr double kBend = 1e-6;

/// Whether the way bends between two strides.
bool Bends(const PlanarPose& a, const PlanarPose& b, const PlanarPose& c) {
  const Eigen::Vector2d before = b.position() - a.position();
  const Eigen::Vector2d after = c.position() - b.position();
  const double turn = WrapAngle(c.yaw - b.yaw) - WrapAngle(b.yaw - a.yaw);
  return (after - before).norm() > kBend || std::abs(turn) > kBend;
}

/// Steps that bring all limbs together in every bend, so that no limb cuts a corner: each swing
/// stays inside the swept volume of one straight way.
std::vector<Step> StepsAlong(const NominalStance& stance,
                             const std::vector<std::vector<int>>& groups,
                             const std::vector<PlanarPose>& strides, const StepBounds& bounds) {
  std::vector<Step> steps;
  std::vector<PlanarPose> line;
  for (std::size_t i = 0; i < strides.size(); ++i) {
    line.push_back(strides[i]);
    const bool is_end =
        i + 1 == strides.size() || (i > 0 && Bends(strides[i - 1], strides[i], strides[i + 1]));
    if (!is_end || line.size() < 2) continue;
    const std::vector<Step> more = PlanSteps(stance, groups, line, bounds);
    if (more.empty()) throw MotionError("no footholds along the way");
    steps.insert(steps.end(), more.begin(), more.end());
    line = {strides[i]};
  }
  if (steps.empty()) throw MotionError("no footholds along the way");
  return steps;
}

/// Steps that fail, and their neighbours, are slowed down by this factor at a time, and by the most
/// in all.
constexpr double kSlower = 1.25;
constexpr double kSlowest = 2;

/// Slows down the step of a schedule's interval (ScheduleOf) and its neighbours. False if the
/// interval is unknown or its step is as slow as it may be.
bool SlowDown(int interval, std::vector<Step>* steps) {
  if (interval < 0) return false;
  const int last = static_cast<int>(steps->size()) - 1;
  const int step = std::clamp((interval - 1) / 2, 0, last);
  if (kSlower * (*steps)[step].slowness > kSlowest) return false;
  for (int i = std::max(0, step - 1); i <= std::min(last, step + 1); ++i) {
    (*steps)[i].slowness *= kSlower;
  }
  return true;
}

/// Shares of a pace's steps aside and in turns that are tried: legs that come too close to each
/// other need shorter ones.
constexpr double kShorter[] = {1, 0.75, 0.5};

Pace Shortened(Pace pace, double share) {
  pace.bounds.lateral *= share;
  pace.bounds.turn *= share;
  return pace;
}

/// Closing up at the end of a straight way, s.
double Stop(const Pace& pace) { return pace.timing.swing; }

double Reach(const NominalStance& stance) {
  double reach = 0;
  for (const Eigen::Vector3d& centre : stance.patch_centres) {
    reach = std::max(reach, centre.head<2>().norm());
  }
  return reach;
}

std::vector<PlanarPose> Repeated(const PlanarPose& displacement, int count) {
  std::vector<PlanarPose> stances = {PlanarPose()};
  for (int i = 0; i < count; ++i) stances.push_back(stances.back() * displacement);
  return stances;
}

}  // namespace

DynamicGait::DynamicGait(const models::RobotModel& robot, const NominalStance& stance,
                         std::vector<Pace> paces)
    : robot_(&robot),
      stance_(&stance),
      quasi_static_(robot, stance),
      groups_(SwingGroups(stance)),
      reach_(Reach(stance)),
      paces_(std::move(paces)) {}

DynamicGait::DynamicGait(const models::RobotModel& robot, const NominalStance& stance)
    : DynamicGait(robot, stance, {}) {
  paces_ = FittedPaces();
}

std::vector<Pace> DynamicGait::FittedPaces() const {
  std::vector<Pace> paces;
  for (const Pace& candidate : Candidates(stance_->gait->parameters)) {
    if (!paces.empty() && candidate.speed() > kSlowPace * paces.front().speed()) continue;
    const std::optional<Pace> pace = Fitted(candidate);
    if (!pace) continue;
    paces.push_back(*pace);
    if (paces.size() == 2) break;
  }
  return paces;
}

bool DynamicGait::Fits(const Pace& pace, const PlanarPose& step) const {
  MotionSettings settings;
  settings.speed_margin = kFitMargin;
  settings.torque_margin = kFitMargin;
  settings.knot_spacing = kKnotSpacing;
  settings.minimum_intervals = kLeastIntervals;
  try {
    const std::vector<Phase> motion = MotionAt(pace, Repeated(step, kFitSteps), settings, false);
    RequireSelfClearance(motion, kFitClearance);
    return true;
  } catch (const MotionError&) {
    return false;
  }
}

std::optional<Pace> DynamicGait::Fitted(Pace pace) const {
  const models::GaitParameters& parameters = stance_->gait->parameters;
  if (!Fits(pace, {pace.bounds.forward, 0, 0})) return std::nullopt;
  const auto longest = [&](double unit, double* bound, const auto& step) {
    for (const double length : kAside) {
      *bound = length * unit;
      // To one side only: every motion is checked by itself, and robots are about symmetric.
      if (Fits(pace, step(*bound))) return true;
    }
    return false;
  };
  if (!longest(parameters.lateral, &pace.bounds.lateral,
               [](double y) {
                 return PlanarPose{0, y, 0};
               }) ||
      !longest(parameters.turn, &pace.bounds.turn, [](double yaw) {
        return PlanarPose{0, 0, yaw};
      })) {
    return std::nullopt;
  }
  return pace;
}

std::vector<Phase> DynamicGait::MotionAt(const Pace& pace, const std::vector<PlanarPose>& strides,
                                         const MotionSettings& settings, bool adapts,
                                         const CancellationToken& cancellation) const {
  std::vector<Step> steps = StepsAlong(*stance_, groups_, strides, pace.bounds);
  while (true) {
    try {
      return MotionOf(pace, strides.front(), steps, settings, cancellation);
    } catch (const MotionError& error) {
      if (!adapts || !SlowDown(error.phase(), &steps)) throw;
    }
  }
}

std::vector<Phase> DynamicGait::MotionOf(const Pace& pace, const PlanarPose& start,
                                         const std::vector<Step>& steps,
                                         const MotionSettings& settings,
                                         const CancellationToken& cancellation) const {
  PatternSettings pattern;
  pattern.clearance = stance_->gait->parameters.clearance;
  pattern.zmp_margin = stance_->gait->parameters.com_margin;
  const ContactSchedule schedule =
      ScheduleOf(*robot_, *stance_, groups_, start, steps, pace.timing);
  Eigen::VectorXd guess = stance_->q;
  guess.segment<2>(4) = start.position();
  std::vector<Phase> motion =
      MotionBuilder(*robot_, settings)
          .Build(PatternPhases(*robot_, *stance_, schedule, pattern, cancellation), guess,
                 cancellation);
  RequireSelfClearance(motion, 0);
  return motion;
}

void DynamicGait::RequireSelfClearance(const std::vector<Phase>& motion, double clearance) const {
  const models::Environment nothing;
  models::CollisionChecker checker(*robot_, nothing);
  dynamics::TreeKinematics kinematics(*robot_);
  for (const Phase& phase : motion) {
    for (const Knot& knot : phase.knots) {
      kinematics.SetPosition(knot.q);
      const std::vector<models::Proximity> close =
          checker.SelfProximities(kinematics.X_WL(), clearance);
      if (close.empty()) continue;
      throw MotionError(fmt::format("{} is {:.4f} m from {} at {:.2f} s, expected {:.4f}",
                                    robot_->links[close.front().link].name, close.front().distance,
                                    robot_->links[close.front().other].name, knot.t, clearance));
    }
  }
}

std::vector<Phase> DynamicGait::Flow(const std::vector<PlanarPose>& strides, double knot_spacing,
                                     const CancellationToken& cancellation) const {
  MotionSettings settings;
  settings.knot_spacing = std::min(knot_spacing, kKnotSpacing);
  settings.minimum_intervals = kLeastIntervals;
  std::string fault = "no pace fits";
  for (const Pace& pace : paces_) {
    for (const double share : kShorter) {
      try {
        return MotionAt(Shortened(pace, share), strides, settings, true, cancellation);
      } catch (const MotionError& error) {
        fault = error.what();
      }
    }
  }
  throw MotionError(fault);
}

std::vector<Phase> DynamicGait::Motion(const std::vector<PlanarPose>& strides, double knot_spacing,
                                       const CancellationToken& cancellation) const {
  try {
    return Flow(strides, knot_spacing, cancellation);
  } catch (const MotionError&) {
    return quasi_static_.Motion(strides, knot_spacing, cancellation);
  }
}

std::vector<std::vector<Phase>> DynamicGait::Variants(const std::vector<PlanarPose>& strides,
                                                      double knot_spacing,
                                                      const CancellationToken& cancellation) const {
  // The volumes of quasi-static motions are unions of their strides'. A slow pace has shorter steps
  // than the quickest one.
  if (strides.size() == 2) return {quasi_static_.Motion(strides, knot_spacing, cancellation)};
  if (paces_.empty()) return {};
  MotionSettings settings;
  settings.knot_spacing = knot_spacing;
  settings.minimum_intervals = 2;
  try {
    return {MotionAt(paces_.front(), strides, settings, false, cancellation)};
  } catch (const MotionError&) {
    return {};  // Motion does not return it either.
  }
}

double DynamicGait::ExpectedDuration(int strides) const {
  if (strides == 0) return 0;
  if (paces_.empty()) return quasi_static_.ExpectedDuration(strides);
  const Pace& pace = paces_.front();
  return strides * stance_->gait->parameters.forward / pace.speed() + Stop(pace);
}

double DynamicGait::ExpectedDurationAlong(const std::vector<PlanarPose>& strides) const {
  if (paces_.empty()) return quasi_static_.ExpectedDurationAlong(strides);
  if (strides.size() < 2) return 0;
  double duration = Stop(paces_.front());
  for (std::size_t i = 0; i + 1 < strides.size(); ++i) {
    duration +=
        DisplacementDuration(stance_->gait->parameters, strides[i].Inverse() * strides[i + 1]);
  }
  return duration;
}

double DynamicGait::DisplacementDuration(const models::GaitParameters& parameters,
                                         const PlanarPose& displacement) const {
  if (paces_.empty()) return quasi_static_.DisplacementDuration(parameters, displacement);
  // Ahead, groups pass each other. Aside and in turns, one makes a step and the other closes up.
  const auto& [bounds, timing] = paces_.front();
  const auto step = [&timing = timing](double length) {
    return SwingTime(timing, length) + timing.double_support;
  };
  return std::abs(displacement.x) / bounds.forward * step(bounds.forward) +
         2 * std::abs(displacement.y) / bounds.lateral * step(bounds.lateral) +
         2 * std::abs(displacement.yaw) / bounds.turn * step(reach_ * bounds.turn);
}

}  // namespace possibility::actions
