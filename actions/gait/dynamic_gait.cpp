#include "actions/gait/dynamic_gait.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

#include "actions/gait/pace_fit.h"
#include "actions/gait/waist_joint.h"
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

/// Distance of links on a way that cannot be walked with kSelfClearance, m.
constexpr double kLeastClearance = 0.005;

/// Links that come too close to each other, in some phases of a motion.
class CloseLinks : public MotionError {
 public:
  CloseLinks(const std::string& message, std::vector<int> phases)
      : MotionError(message, phases.front()), phases_(std::move(phases)) {}
  const std::vector<int>& phases() const { return phases_; }

 private:
  std::vector<int> phases_;
};

/// Where ways meet, most bends are rounded: they cost this share of a Stop. The rest of one is part
/// of the RestTime at both ends. Most of a turn is then made on the way: it costs this share of a
/// turn on the spot.
constexpr double kBendOfStop = 0.5;
constexpr double kTurnOnTheWay = 0.7;

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

}  // namespace

DynamicGait::DynamicGait(const models::RobotModel& robot, const NominalStance& stance,
                         std::vector<Pace> paces)
    : robot_(&robot),
      stance_(&stance),
      quasi_static_(robot, stance),
      groups_(SwingGroups(stance)),
      reach_(Reach(stance)),
      waist_(WaistJoint(robot, stance)),
      paces_(std::move(paces)) {
  for (Pace& pace : paces_) pace.groups = static_cast<int>(groups_.size());
}

DynamicGait::DynamicGait(const models::RobotModel& robot, const NominalStance& stance)
    : DynamicGait(robot, stance, FitPaces(robot, stance)) {}

MotionSettings DynamicGait::Settings() const {
  MotionSettings settings;
  settings.knot_spacing = groups_.size() > 2 ? kFineKnotSpacing : kKnotSpacing;
  settings.minimum_intervals = kLeastIntervals;
  // A foot that is about to lift bears little, and what is missing between knots may be more than
  // its friction leaves: 1 of 500 short walks was refused by the verifier.
  settings.tests_between_knots = true;
  return settings;
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
  return MotionAt(pace, StraightLines(strides), DemandsOf(settings, {}), adapts, cancellation);
}

std::vector<Phase> DynamicGait::MotionAt(const Pace& pace, const std::vector<StanceLine>& lines,
                                         const Demands& demands, bool adapts,
                                         const CancellationToken& cancellation) const {
  SteppedWay way(*stance_, groups_, lines, pace.bounds);
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
  pattern.grid = Settings().knot_spacing;
  pattern.least_steps = kLeastIntervals;
  pattern.evenness = pace.style.evenness;
  pattern.lean = pace.style.lean;
  pattern.zmp_ahead = pace.style.zmp_ahead;
  pattern.keeps_reach = pace.style.keeps_reach;
  pattern.end_joints = demands.end.joints;
  pattern.turning_time = demands.end.turning_time;
  const models::ContactSchedule schedule =
      ScheduleOf(*robot_, *stance_, groups_, way.start(), way.Steps(), pace.timing);
  pattern.turn = pace.style.turn;
  pattern.twist = pace.style.twist;
  pattern.shares = SharesOf(pace, schedule);
  pattern.waist = waist_;
  Eigen::VectorXd guess = stance_->q;
  guess.segment<2>(4) = way.start().position();
  std::vector<Phase> motion =
      MotionBuilder(*robot_, demands.settings)
          .Build(PatternPhases(*robot_, *stance_, schedule, pattern, cancellation), guess,
                 cancellation);
  RequireSelfClearance(motion, demands);
  return motion;
}

std::vector<double> DynamicGait::SharesOf(const Pace& pace,
                                          const models::ContactSchedule& schedule) const {
  std::vector<double> shares(schedule.intervals.size(), 0);
  for (int k = 1; k + 1 < static_cast<int>(shares.size()); ++k) {
    for (int limb = 0; limb < static_cast<int>(schedule.contacts.size()); ++limb) {
      if (schedule.intervals[k].bearing[limb]) continue;
      const Eigen::Isometry3d& from = schedule.Before(k, limb);
      const Eigen::Vector3d way = schedule.After(k, limb).translation() - from.translation();
      const double heading = std::atan2(from(1, 0), from(0, 0)) - stance_->patch_headings[limb];
      const double ahead = std::cos(heading) * way.x() + std::sin(heading) * way.y();
      shares[k] = std::clamp(ahead / (2 * pace.bounds.forward), 0.0, 1.0);
    }
  }
  return shares;
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

std::vector<std::vector<StanceLine>> DynamicGait::Divided(
    const std::vector<StanceLine>& lines) const {
  std::vector<double> times = {0};  // at the end of each stride
  for (const StanceLine& line : lines) {
    for (std::size_t i = 1; i < line.size(); ++i) {
      const PlanarPose displacement = line[i - 1].Inverse() * line[i];
      const bool comes_from_another = i == 1 && times.size() > 1;
      times.push_back(times.back() + (comes_from_another ? Stop(paces_.front()) : 0) +
                      DurationOf(displacement, 1));
    }
  }
  const double parts = std::max(1.0, std::ceil(times.back() / kLongestFlow));
  std::vector<std::vector<StanceLine>> ways = {{}};
  std::size_t stride = 0;
  for (const StanceLine& line : lines) {
    ways.back().push_back({line.front()});
    for (std::size_t i = 1; i < line.size(); ++i) {
      ways.back().back().push_back(line[i]);
      const bool is_last = ++stride + 1 == times.size();
      const double share = static_cast<double>(ways.size()) / parts;
      if (is_last || times[stride] < share * times.back()) continue;
      ways.emplace_back();
      if (i + 1 < line.size()) ways.back().push_back({line[i]});
    }
  }
  return ways;
}

std::vector<Phase> DynamicGait::Flow(const std::vector<StanceLine>& lines, const FlowEnd& end,
                                     double knot_spacing,
                                     const CancellationToken& cancellation) const {
  if (paces_.empty()) throw MotionError("no pace fits the gait");
  const std::vector<std::vector<StanceLine>> ways = Divided(lines);
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

std::vector<Phase> DynamicGait::FlowThrough(const std::vector<StanceLine>& lines,
                                            const FlowEnd& end, double knot_spacing,
                                            const CancellationToken& cancellation) const {
  MotionSettings settings = Settings();
  settings.knot_spacing = std::min(knot_spacing, settings.knot_spacing);
  Demands demands = DemandsOf(settings, end);
  std::string fault = "no pace fits";
  for (const double clearance : {kSelfClearance, kLeastClearance}) {
    demands.clearance = clearance;
    std::vector<Phase> shortest;
    for (const auto& [duration, pace] : ByDuration(lines)) {
      if (!shortest.empty() && duration >= shortest.back().knots.back().t) break;
      try {
        std::vector<Phase> motion = MotionAt(*pace, lines, demands, true, cancellation);
        const bool is_shorter =
            shortest.empty() || motion.back().knots.back().t < shortest.back().knots.back().t;
        if (is_shorter) shortest = std::move(motion);
      } catch (const MotionError& error) {
        fault = error.what();
      }
    }
    if (!shortest.empty()) return shortest;
  }
  throw MotionError(fault);
}

std::vector<std::pair<double, const Pace*>> DynamicGait::ByDuration(
    const std::vector<StanceLine>& lines) const {
  std::vector<std::pair<double, const Pace*>> paces;
  for (const Pace& pace : paces_) {
    double duration = std::numeric_limits<double>::infinity();
    try {
      const SteppedWay way(*stance_, groups_, lines, pace.bounds);
      duration =
          ScheduleOf(*robot_, *stance_, groups_, way.start(), way.Steps(), pace.timing).duration();
    } catch (const MotionError&) {
      // Nor will there be a motion at this pace.
    }
    paces.emplace_back(duration, &pace);
  }
  std::stable_sort(paces.begin(), paces.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  return paces;
}

std::vector<Phase> DynamicGait::Motion(const std::vector<PlanarPose>& strides, double knot_spacing,
                                       const CancellationToken& cancellation) const {
  try {
    return Flow(StraightLines(strides), {}, knot_spacing, cancellation);
  } catch (const MotionError&) {
    return quasi_static_.Motion(strides, knot_spacing, cancellation);
  }
}

std::vector<std::vector<Phase>> DynamicGait::Variants(const std::vector<PlanarPose>& strides,
                                                      double knot_spacing,
                                                      const CancellationToken& cancellation) const {
  // The volumes of quasi-static motions are unions of their strides'.
  std::vector<std::vector<Phase>> variants;
  if (strides.size() == 2) {
    variants.push_back(quasi_static_.Motion(strides, knot_spacing, cancellation));
  }
  MotionSettings settings;
  settings.knot_spacing = knot_spacing;
  settings.minimum_intervals = 2;
  for (const Pace& pace : paces_) {
    // A slow pace has shorter steps than the one before, if it carries the body in the same way and
    // no higher.
    const bool is_within = &pace != paces_.data() && pace.rise <= (&pace - 1)->rise &&
                           pace.style == (&pace - 1)->style;
    if (is_within) continue;
    try {
      variants.push_back(MotionAt(pace, strides, settings, false, cancellation));
    } catch (const MotionError&) {
      // Motion does not return it either.
    }
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
  double duration = kBendOfStop * Stop(paces_.front());
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

double DynamicGait::RestTime() const {
  if (paces_.empty()) return 0;
  return paces_.front().timing.start + (1 - kBendOfStop) * Stop(paces_.front()) / 2;
}

double DynamicGait::DisplacementDuration(const models::GaitParameters& parameters,
                                         const PlanarPose& displacement) const {
  if (paces_.empty()) return quasi_static_.DisplacementDuration(parameters, displacement);
  return DurationOf(displacement, kTurnOnTheWay);
}

double DynamicGait::DurationOf(const PlanarPose& displacement, double share_of_turn) const {
  // Ahead, groups pass each other. Aside and in turns, one makes a step and the other closes up.
  const StepBounds& bounds = paces_.front().bounds;
  const StepTiming& timing = paces_.front().timing;
  const double each = paces_.front().StepsEach();
  const auto step = [&](double length) {
    return each * (SwingTime(timing, length) + timing.double_support);
  };
  return std::abs(displacement.x) / bounds.forward * step(bounds.forward) +
         2 * std::abs(displacement.y) / bounds.lateral * step(bounds.lateral) +
         share_of_turn * 2 * std::abs(displacement.yaw) / bounds.turn * step(reach_ * bounds.turn);
}

}  // namespace possibility::actions
