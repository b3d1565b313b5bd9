#include "actions/gait/dynamic_gait.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include "actions/motion/phase_sequence.h"
#include "actions/wholebody/motion_error.h"
#include "dynamics/tree/tree_kinematics.h"

namespace possibility::actions {
namespace {

/// Knots of dynamic motion: at most this far apart, s, and at least this many intervals in a phase.
constexpr double kKnotSpacing = 0.02;
/// Where limbs swing one by one, three points may bear: what is missing between knots falls on few
/// forces, some of them small and near the edge of their cones.
constexpr double kFineKnotSpacing = 0.01;
constexpr int kLeastIntervals = 4;

/// Fitted paces leave this share of joint speeds and torques, and this much more distance
/// between links, m, for bends and unequal steps.
constexpr double kFitMargin = 0.92;
constexpr double kFitClearance = 0.0005;

/// Family of paces: lengths of steps and durations of swings and double supports, in multiples of
/// quasi-static strides' bounds and swing time.
constexpr double kLengths[] = {1.6, 1.5, 1.4, 1.3, 1.2, 1.1, 1.0, 0.8};
constexpr double kSwings[] = {0.6, 0.7, 0.8, 0.9, 1.0};
constexpr double kDoubleSupport = 0.12;
constexpr double kStart = 0.7;  // start and stop, in which the root rises and comes down
/// Sideways and turning steps, in multiples of strides; one limb closes up to the other.
constexpr double kAside[] = {3, 2.8, 2.6, 2.4, 2.2, 2, 1.8, 1.6, 1.4, 1.2, 1};

/// Steps of the ways that a pace is tried on.
constexpr int kFitSteps = 4;

/// Distance of links on a way that cannot be walked with kSelfClearance, m.
constexpr double kLeastClearance = 0.005;

/// Rises of the root in motion, as shares of its height: straighter legs bear with less torque.
constexpr double kRises[] = {0.14, 0.105, 0.07, 0.035, 0};

/// Beside the quickest pace, the quickest below this share of its speed is kept.
constexpr double kSlowPace = 0.6;

/// Family of paces of a gait, quickest first.
std::vector<Pace> Candidates(const models::GaitParameters& parameters, double height,
                             std::size_t groups) {
  std::vector<Pace> paces;
  for (const double length : kLengths) {
    for (const double swing : kSwings) {
      Pace pace;
      pace.groups = static_cast<int>(groups);
      pace.bounds = {length * parameters.forward, parameters.lateral, parameters.turn};
      pace.timing.swing = swing * parameters.swing_time;
      pace.timing.swing_length = pace.bounds.forward;
      pace.timing.double_support = kDoubleSupport * parameters.swing_time;
      pace.timing.start = kStart * parameters.swing_time;
      for (const double rise : kRises) {
        pace.rise = rise * height;
        paces.push_back(pace);
      }
    }
  }
  std::stable_sort(paces.begin(), paces.end(),
                   [](const Pace& a, const Pace& b) { return a.speed() > b.speed(); });
  return paces;
}

/// Links that come too close to each other, in some phases of a motion.
class CloseLinks : public MotionError {
 public:
  CloseLinks(const std::string& message, std::vector<int> phases)
      : MotionError(message, phases.front()), phases_(std::move(phases)) {}
  const std::vector<int>& phases() const { return phases_; }

 private:
  std::vector<int> phases_;
};

/// Closing up at the end of a straight way, s, and a share of a step because ways are no whole
/// number of steps. On average it is less than half: some ways fit.
double Stop(const Pace& pace) {
  return pace.timing.swing + (pace.timing.swing + pace.timing.double_support) / 3;
}

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
      paces_(std::move(paces)) {
  for (Pace& pace : paces_) pace.groups = static_cast<int>(groups_.size());
}

DynamicGait::DynamicGait(const models::RobotModel& robot, const NominalStance& stance)
    : DynamicGait(robot, stance, {}) {
  paces_ = FittedPaces();
}

std::vector<Pace> DynamicGait::FittedPaces() const {
  std::vector<Pace> paces;
  for (const Pace& candidate :
       Candidates(stance_->gait->parameters, stance_->gait->posture.root_height, groups_.size())) {
    if (!paces.empty() && candidate.speed() > kSlowPace * paces.front().speed()) continue;
    const std::optional<Pace> pace = Fitted(candidate);
    if (!pace) continue;
    paces.push_back(*pace);
    if (paces.size() == 2) break;
  }
  return paces;
}

double DynamicGait::KnotSpacing() const {
  return groups_.size() > 2 ? kFineKnotSpacing : kKnotSpacing;
}

bool DynamicGait::Fits(const Pace& pace, const PlanarPose& step) const {
  MotionSettings settings;
  settings.speed_margin = kFitMargin;
  settings.torque_margin = kFitMargin;
  settings.knot_spacing = KnotSpacing();
  settings.minimum_intervals = kLeastIntervals;
  try {
    Demands demands = DemandsOf(settings, {});
    demands.clearance = kSelfClearance + kFitClearance;
    MotionAt(pace, Repeated(step, kFitSteps), demands, false, {});
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

DynamicGait::Demands DynamicGait::DemandsOf(const MotionSettings& settings,
                                            const FlowEnd& end) const {
  std::vector<Eigen::VectorXd> rests = {stance_->q};
  if (end.joints.size() > 0) {
    rests.push_back(stance_->q);
    rests.back().tail(robot_->num_joints()) = end.joints;
  }
  return {settings, end, SelfClearance(*robot_, rests), kLeastClearance};
}

std::vector<Phase> DynamicGait::MotionAt(const Pace& pace, const std::vector<PlanarPose>& strides,
                                         const MotionSettings& settings, bool adapts,
                                         const CancellationToken& cancellation) const {
  return MotionAt(pace, strides, DemandsOf(settings, {}), adapts, cancellation);
}

std::vector<Phase> DynamicGait::MotionAt(const Pace& pace, const std::vector<PlanarPose>& strides,
                                         const Demands& demands, bool adapts,
                                         const CancellationToken& cancellation) const {
  SteppedWay way(*stance_, groups_, strides, pace.bounds);
  while (true) {
    try {
      return MotionOf(pace, way, demands, cancellation);
    } catch (const CloseLinks& error) {
      if (!adapts || !way.Shorten(error.phases())) throw;
    } catch (const MotionError& error) {
      if (!adapts || !(way.SlowDown(error.phase()) || way.Shorten({error.phase()}))) throw;
    }
  }
}

std::vector<Phase> DynamicGait::MotionOf(const Pace& pace, const SteppedWay& way,
                                         const Demands& demands,
                                         const CancellationToken& cancellation) const {
  PatternSettings pattern;
  pattern.clearance = stance_->gait->parameters.clearance;
  pattern.zmp_margin = stance_->gait->parameters.com_margin;
  pattern.rise = pace.rise;
  pattern.rise_time = pace.timing.start;
  pattern.end_joints = demands.end.joints;
  pattern.turning_time = demands.end.turning_time;
  const models::ContactSchedule schedule =
      ScheduleOf(*robot_, *stance_, groups_, way.start(), way.Steps(), pace.timing);
  Eigen::VectorXd guess = stance_->q;
  guess.segment<2>(4) = way.start().position();
  std::vector<Phase> motion =
      MotionBuilder(*robot_, demands.settings)
          .Build(PatternPhases(*robot_, *stance_, schedule, pattern, cancellation), guess,
                 cancellation);
  RequireSelfClearance(motion, demands);
  return motion;
}

void DynamicGait::RequireSelfClearance(const std::vector<Phase>& motion,
                                       const Demands& demands) const {
  dynamics::TreeKinematics kinematics(*robot_);
  std::string first;
  std::vector<int> phases;
  for (std::size_t i = 0; i < motion.size(); ++i) {
    for (const Knot& knot : motion[i].knots) {
      kinematics.SetPosition(knot.q);
      const auto faults = demands.self_clearance.Faults(kinematics.X_WL(), demands.clearance);
      if (faults.empty()) continue;
      const auto& [pair, required] = faults.front();
      if (phases.empty()) {
        first = fmt::format("{} is {:.4f} m from {} at {:.2f} s, expected {:.4f}",
                            robot_->links[pair.link].name, pair.distance,
                            robot_->links[pair.other].name, knot.t, required);
      }
      phases.push_back(static_cast<int>(i));
      break;
    }
  }
  if (!phases.empty()) throw CloseLinks(first, phases);
}

std::vector<std::vector<PlanarPose>> DynamicGait::Divided(
    const std::vector<PlanarPose>& strides) const {
  std::vector<double> times = {0};
  for (std::size_t i = 1; i < strides.size(); ++i) {
    const PlanarPose displacement = strides[i - 1].Inverse() * strides[i];
    const bool bends = i > 1 && Bends(strides[i - 2], strides[i - 1], strides[i]);
    times.push_back(times.back() + (bends ? Stop(paces_.front()) : 0) +
                    DisplacementDuration(stance_->gait->parameters, displacement));
  }
  const double parts = std::max(1.0, std::ceil(times.back() / kLongestFlow));
  std::vector<std::vector<PlanarPose>> ways = {{strides.front()}};
  for (std::size_t i = 1; i < strides.size(); ++i) {
    ways.back().push_back(strides[i]);
    const bool is_last = i + 1 == strides.size();
    const double share = static_cast<double>(ways.size()) / parts;
    if (!is_last && times[i] >= share * times.back()) ways.push_back({strides[i]});
  }
  return ways;
}

std::vector<Phase> DynamicGait::Flow(const std::vector<PlanarPose>& strides, const FlowEnd& end,
                                     double knot_spacing,
                                     const CancellationToken& cancellation) const {
  const std::vector<std::vector<PlanarPose>> ways = Divided(strides);
  std::vector<Phase> motion;
  for (std::size_t i = 0; i < ways.size(); ++i) {
    const bool is_last = i + 1 == ways.size();
    std::vector<Phase> more =
        FlowThrough(ways[i], is_last ? end : FlowEnd(), knot_spacing, cancellation);
    if (!motion.empty()) ShiftTime(motion.back().knots.back().t, &more);
    std::move(more.begin(), more.end(), std::back_inserter(motion));
  }
  return motion;
}

std::vector<Phase> DynamicGait::FlowThrough(const std::vector<PlanarPose>& strides,
                                            const FlowEnd& end, double knot_spacing,
                                            const CancellationToken& cancellation) const {
  MotionSettings settings;
  settings.knot_spacing = std::min(knot_spacing, KnotSpacing());
  settings.minimum_intervals = kLeastIntervals;
  Demands demands = DemandsOf(settings, end);
  std::string fault = "no pace fits";
  for (const double clearance : {kSelfClearance, kLeastClearance}) {
    demands.clearance = clearance;
    for (const Pace& pace : paces_) {
      try {
        return MotionAt(pace, strides, demands, true, cancellation);
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
    return Flow(strides, {}, knot_spacing, cancellation);
  } catch (const MotionError&) {
    return quasi_static_.Motion(strides, knot_spacing, cancellation);
  }
}

std::vector<std::vector<Phase>> DynamicGait::Variants(const std::vector<PlanarPose>& strides,
                                                      double knot_spacing,
                                                      const CancellationToken& cancellation) const {
  // The volumes of quasi-static motions are unions of their strides'. A slow pace has shorter steps
  // than the quickest one.
  std::vector<std::vector<Phase>> variants;
  if (strides.size() == 2) {
    variants.push_back(quasi_static_.Motion(strides, knot_spacing, cancellation));
  }
  if (paces_.empty()) return variants;
  MotionSettings settings;
  settings.knot_spacing = knot_spacing;
  settings.minimum_intervals = 2;
  try {
    variants.push_back(MotionAt(paces_.front(), strides, settings, false, cancellation));
  } catch (const MotionError&) {
    // Motion does not return it either.
  }
  return variants;
}

double DynamicGait::ExpectedDuration(int strides) const {
  if (strides == 0) return 0;
  if (paces_.empty()) return quasi_static_.ExpectedDuration(strides);
  const Pace& pace = paces_.front();
  return strides * stance_->gait->parameters.forward / pace.speed() + Stop(pace);
}

double DynamicGait::WayDuration(const models::GaitParameters& parameters, const PlanarPose& from,
                                const PlanarPose& to) const {
  if (paces_.empty()) return quasi_static_.WayDuration(parameters, from, to);
  if (StrideCount(parameters, from, to) == 0) return 0;
  double duration = Stop(paces_.front());
  if (ClassOfStrides(from, to) != StrideClass::kAny) {
    // All strides have one direction in the stance's frame, and duration is linear in them.
    PlanarPose way = from.Inverse() * to;
    way.yaw = WrapAngle(way.yaw);
    return duration + DisplacementDuration(parameters, way);
  }
  const std::vector<PlanarPose> strides = PlanStrides(parameters, from, to);
  for (std::size_t i = 0; i + 1 < strides.size(); ++i) {
    duration += DisplacementDuration(parameters, strides[i].Inverse() * strides[i + 1]);
  }
  return duration;
}

double DynamicGait::DisplacementDuration(const models::GaitParameters& parameters,
                                         const PlanarPose& displacement) const {
  if (paces_.empty()) return quasi_static_.DisplacementDuration(parameters, displacement);
  // Ahead, groups pass each other. Aside and in turns, one makes a step and the other closes up.
  const StepBounds& bounds = paces_.front().bounds;
  const StepTiming& timing = paces_.front().timing;
  const double each = paces_.front().StepsEach();
  const auto step = [&](double length) {
    return each * (SwingTime(timing, length) + timing.double_support);
  };
  return std::abs(displacement.x) / bounds.forward * step(bounds.forward) +
         2 * std::abs(displacement.y) / bounds.lateral * step(bounds.lateral) +
         2 * std::abs(displacement.yaw) / bounds.turn * step(reach_ * bounds.turn);
}

}  // namespace possibility::actions
