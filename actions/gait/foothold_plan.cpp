#include "actions/gait/foothold_plan.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "actions/wholebody/support_polygon.h"

namespace possibility::actions {
namespace {

using Eigen::Vector2d;
using Groups = std::vector<std::vector<int>>;

/// Gap between two limbs' patches that steps leave: a share of the nominal gap, and no more than a
/// length in m.
constexpr double kGapShare = 0.6;
constexpr double kGap = 0.02;

/// A group beside another one may turn in by this share of what it may turn out: thighs come close.
constexpr double kTurnIn = 0.65;
constexpr double kBeside = 0.01;  // m

/// Exponent of CombinedEffort.
constexpr double kCombination = 1.5;

/// Ways are cut into pieces of this share of a bound, to find the longest step.
constexpr double kPiece = 1.0 / 16;

/// Shortest swing, as a share of the longest one's duration.
constexpr double kShortestSwing = 0.75;

std::vector<Vector2d> Placed(const NominalStance& stance, int limb, const PlanarPose& at) {
  std::vector<Vector2d> points;
  for (const Vector2d& p : stance.bearing_points[limb]) points.push_back(at * p);
  return points;
}

/// Least distance between the patches of two limbs; negative where they overlap.
double Gap(const NominalStance& stance, int limb, const PlanarPose& at, int other,
           const PlanarPose& other_at) {
  const SupportPolygon a(Placed(stance, limb, at));
  const SupportPolygon b(Placed(stance, other, other_at));
  double gap = std::numeric_limits<double>::infinity();
  for (const Vector2d& p : a.vertices()) gap = std::min(gap, -b.Margin(p));
  for (const Vector2d& p : b.vertices()) gap = std::min(gap, -a.Margin(p));
  return gap;
}

double MarginOfPair(const NominalStance& stance, int a, int b) {
  std::vector<Vector2d> points = Placed(stance, a, {});
  const std::vector<Vector2d> others = Placed(stance, b, {});
  points.insert(points.end(), others.begin(), others.end());
  return SupportPolygon(points).Margin(stance.centre_of_mass);
}

/// Whether two limbs together bear on a line or less.
bool BearOnALine(const NominalStance& stance, const std::vector<int>& limbs) {
  std::size_t points = 0;
  for (const int limb : limbs) points += stance.bearing_points[limb].size();
  return points < 3;
}

/// A way of straight lines through stances, by a parameter from 0 to its number of lines.
class Way {
 public:
  explicit Way(const std::vector<PlanarPose>& stances) : stances_(stances) {}

  double end() const { return static_cast<double>(stances_.size()) - 1; }

  PlanarPose At(double u) const {
    if (u >= end()) return stances_.back();
    const auto line = static_cast<std::size_t>(u);
    return Interpolate(stances_[line], stances_[line + 1], u - static_cast<double>(line));
  }

 private:
  const std::vector<PlanarPose>& stances_;
};

/// Bounds of a step beside another group.
struct Bounds : StepBounds {
  double side = 0;  ///< m: by how much the group is farther to the left than the other one
};

double Effort(const Bounds& bounds, const PlanarPose& from, const PlanarPose& to) {
  const PlanarPose d = from.Inverse() * to;
  const double yaw = WrapAngle(d.yaw);
  const bool turns_in = yaw * bounds.side < -kBeside * std::abs(yaw);
  return CombinedEffort(d.x / bounds.forward, d.y / bounds.lateral,
                        yaw / (turns_in ? kTurnIn * bounds.turn : bounds.turn));
}

/// Lays out the steps along one way.
class StepPlanner {
 public:
  StepPlanner(const NominalStance& stance, const Groups& groups, const Way& way,
              const StepBounds& bounds, const std::vector<double>& shares)
      : stance_(stance), groups_(groups), way_(way), bounds_(bounds), shares_(shares) {}

  /// Steps that use `share` of the bounds; none if the limbs cannot get on.
  std::vector<Step> Plan(double share) const {
    std::vector<double> at(groups_.size(), 0);
    std::vector<Step> steps;
    int last = -1;
    while (!Arrived(at)) {
      int best = -1;
      double best_target = 0;
      for (int k = 1; k <= static_cast<int>(groups_.size()); ++k) {
        // Groups take turns, unless the next one cannot advance.
        const int group = (last + k) % static_cast<int>(groups_.size());
        const double target = Farthest(group, at, share);
        const double progress = target - at[group];
        if (progress <= 1e-9) continue;
        if (best < 0 || (last < 0 && target > best_target + 1e-9)) {
          best = group;
          best_target = target;
        }
        if (last >= 0) break;
      }
      if (best < 0) return {};
      at[best] = best_target;
      steps.push_back({best, way_.At(best_target), 1});
      last = best;
    }
    return steps;
  }

 private:
  bool Arrived(const std::vector<double>& at) const {
    return std::all_of(at.begin(), at.end(), [&](double u) { return u >= way_.end(); });
  }

  /// The farthest parameter that a group can step to.
  double Farthest(int group, const std::vector<double>& at, double share) const {
    double limit = way_.end();
    double farthest = at[group];
    for (double u = at[group]; u < limit;) {
      u = std::min(u + Piece(u), limit);
      if (!Allowed(group, u, at, share)) {
        if (u > FarthestOther(group, at)) break;
        continue;
      }
      farthest = u;
    }
    return farthest;
  }

  /// The straight line of the way that begins at u or holds it.
  double LineAt(double u) const { return std::min(std::floor(u + 1e-9), way_.end() - 1); }

  /// Of a step of a group to u.
  Bounds BoundsOf(int group, int other, double u) const {
    Bounds bounds{bounds_, Side(group) - Side(other)};
    if (shares_.empty()) return bounds;
    const double share = shares_[static_cast<std::size_t>(LineAt(u))];
    bounds.lateral *= share;
    bounds.turn *= share;
    return bounds;
  }

  /// Length of a piece of the way at u, in its parameter.
  double Piece(double u) const {
    const double line = LineAt(u);
    const double effort = Effort({bounds_}, way_.At(line), way_.At(line + 1));
    return effort > 0 ? std::min(1.0, kPiece / effort) : 1;
  }

  /// How far left the limbs of a group stand on average, m.
  double Side(int group) const {
    double side = 0;
    for (const int limb : groups_[group]) side += stance_.patch_centres[limb].y();
    return side / static_cast<double>(groups_[group].size());
  }

  double FarthestOther(int group, const std::vector<double>& at) const {
    double farthest = 0;
    for (int other = 0; other < static_cast<int>(at.size()); ++other) {
      if (other != group) farthest = std::max(farthest, at[other]);
    }
    return farthest;
  }

  bool Allowed(int group, double u, const std::vector<double>& at, double share) const {
    const PlanarPose target = way_.At(u);
    for (int other = 0; other < static_cast<int>(groups_.size()); ++other) {
      if (other == group) continue;
      const PlanarPose standing = way_.At(at[other]);
      if (Effort(BoundsOf(group, other, u), standing, target) > share + 1e-9) return false;
      if (!ClearOf(groups_[group], target, groups_[other], standing)) return false;
    }
    return true;
  }

  bool ClearOf(const std::vector<int>& limbs, const PlanarPose& target,
               const std::vector<int>& others, const PlanarPose& standing) const {
    for (const int limb : limbs) {
      for (const int other : others) {
        const double gap = Gap(stance_, limb, target, other, standing) + 1e-9;
        if (gap < kGap && gap < kGapShare * Gap(stance_, limb, {}, other, {})) return false;
      }
    }
    return true;
  }

  const NominalStance& stance_;
  const Groups& groups_;
  const Way& way_;
  const StepBounds& bounds_;
  const std::vector<double>& shares_;
};

}  // namespace

double CombinedEffort(double ahead, double aside, double turn) {
  const auto power = [](double part) { return std::pow(std::abs(part), kCombination); };
  return std::pow(power(ahead) + power(aside) + power(turn), 1 / kCombination);
}

double SwingTime(const StepTiming& timing, double length) {
  return timing.swing * std::clamp(length / timing.swing_length, kShortestSwing, 1.0);
}

std::vector<std::vector<int>> SwingGroups(const NominalStance& stance) {
  const int limbs = static_cast<int>(stance.gait->limbs.size());
  Groups groups;
  if (limbs == 4) {
    double best = -std::numeric_limits<double>::infinity();
    for (int other = 1; other < 4; ++other) {
      std::vector<int> rest;
      for (int limb = 1; limb < 4; ++limb) {
        if (limb != other) rest.push_back(limb);
      }
      const double margin =
          std::min(MarginOfPair(stance, 0, other), MarginOfPair(stance, rest[0], rest[1]));
      if (margin <= best) continue;
      best = margin;
      groups = {{0, other}, rest};
    }
    const bool balances =
        std::none_of(groups.begin(), groups.end(),
                     [&](const std::vector<int>& pair) { return BearOnALine(stance, pair); });
    if (balances) return groups;
    groups.clear();
  }
  for (int limb = 0; limb < limbs; ++limb) groups.push_back({limb});
  return groups;
}

std::vector<Step> PlanSteps(const NominalStance& stance, const Groups& groups,
                            const std::vector<PlanarPose>& way, const StepBounds& bounds,
                            const std::vector<double>& shares) {
  const Way line(way);
  const StepPlanner planner(stance, groups, line, bounds, shares);
  std::vector<Step> steps = planner.Plan(1);
  double enough = 1;
  double little = 0;
  for (int i = 0; i < 6 && !steps.empty(); ++i) {
    const double share = (enough + little) / 2;
    std::vector<Step> equal = planner.Plan(share);
    if (!equal.empty() && equal.size() <= steps.size()) {
      steps = std::move(equal);
      enough = share;
    } else {
      little = share;
    }
  }
  return steps;
}

models::ContactSchedule ScheduleOf(const models::RobotModel& robot, const NominalStance& stance,
                                   const Groups& groups, const PlanarPose& start,
                                   const std::vector<Step>& steps, const StepTiming& timing) {
  const int limbs = static_cast<int>(stance.gait->limbs.size());
  models::ContactInterval standing;
  standing.duration = timing.start;
  const auto place = [&](int limb, const PlanarPose& at) {
    standing.bearing[limb] =
        at.At(0) * Eigen::Translation3d(stance.patch_centres[limb]) *
        Eigen::AngleAxisd(stance.patch_headings[limb], Eigen::Vector3d::UnitZ());
  };
  standing.bearing.resize(limbs);
  for (int limb = 0; limb < limbs; ++limb) place(limb, start);
  models::ContactSchedule schedule;
  for (const models::GaitLimb& limb : stance.gait->limbs) {
    schedule.contacts.push_back(robot.contacts[limb.contact].name);
  }
  schedule.intervals.push_back(standing);
  for (const Step& step : steps) {
    models::ContactInterval swing = standing;
    double distance = 0;
    for (const int limb : groups[step.group]) {
      const Eigen::Vector3d from = standing.bearing[limb]->translation();
      swing.bearing[limb].reset();
      place(limb, step.stance);
      distance = std::max(distance, (standing.bearing[limb]->translation() - from).norm());
    }
    swing.duration = step.slowness * SwingTime(timing, distance);
    schedule.intervals.push_back(std::move(swing));
    standing.duration = timing.double_support;
    schedule.intervals.push_back(standing);
  }
  schedule.intervals.back().duration = timing.start;
  return schedule;
}

}  // namespace possibility::actions
