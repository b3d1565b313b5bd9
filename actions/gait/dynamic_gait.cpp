#include "actions/gait/dynamic_gait.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

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

std::vector<PlanarPose> Repeated(const PlanarPose& displacement, int count) {
  std::vector<PlanarPose> stances = {PlanarPose()};
  for (int i = 0; i < count; ++i) stances.push_back(stances.back() * displacement);
  return stances;
}

}  // namespace

DynamicGait::DynamicGait(const models::RobotModel& robot, const NominalStance& stance)
    : robot_(&robot), stance_(&stance), quasi_static_(robot, stance), groups_(SwingGroups(stance)) {
  for (const Pace& candidate : Candidates(stance.gait->parameters)) {
    if (!paces_.empty() && candidate.speed() > kSlowPace * paces_.front().speed()) continue;
    const std::optional<Pace> pace = Fitted(candidate);
    if (!pace) continue;
    paces_.push_back(*pace);
    if (paces_.size() == 2) break;
  }
}

bool DynamicGait::Fits(const Pace& pace, const PlanarPose& step) const {
  MotionSettings settings;
  settings.speed_margin = kFitMargin;
  settings.torque_margin = kFitMargin;
  settings.knot_spacing = kKnotSpacing;
  settings.minimum_intervals = kLeastIntervals;
  try {
    const std::vector<Phase> motion = MotionAt(pace, Repeated(step, kFitSteps), settings);
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
      if (Fits(pace, step(*bound)) && Fits(pace, step(-*bound))) return true;
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
                                         const MotionSettings& settings,
                                         const CancellationToken& cancellation) const {
  const std::vector<Step> steps = StepsAlong(*stance_, groups_, strides, pace.bounds);
  PatternSettings pattern;
  pattern.clearance = stance_->gait->parameters.clearance;
  pattern.zmp_margin = stance_->gait->parameters.com_margin;
  const ContactSchedule schedule =
      ScheduleOf(*stance_, groups_, strides.front(), steps, pace.timing);
  Eigen::VectorXd guess = stance_->q;
  guess.segment<2>(4) = strides.front().position();
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
    try {
      return MotionAt(pace, strides, settings, cancellation);
    } catch (const MotionError& error) {
      fault = error.what();
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
    return {MotionAt(paces_.front(), strides, settings, cancellation)};
  } catch (const MotionError&) {
    return {};  // Motion does not return it either.
  }
}

double DynamicGait::ExpectedDuration(int strides) const {
  if (strides == 0) return 0;
  if (paces_.empty()) return quasi_static_.ExpectedDuration(strides);
  // The robot rests only where a gait begins and ends. Bends cost about a swing.
  const Pace& pace = paces_.front();
  return strides * stance_->gait->parameters.forward / pace.speed() + pace.timing.swing / 2;
}

}  // namespace possibility::actions
