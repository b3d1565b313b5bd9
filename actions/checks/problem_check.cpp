#include "actions/checks/problem_check.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "actions/plan/contact_name.h"
#include "actions/plan/segment_action.h"
#include "models/input/action_name.h"

namespace possibility::actions {
namespace {

using Eigen::Vector2d;

template <typename Named>
const Named* FindNamed(const std::vector<Named>& items, const std::string& name) {
  const auto found = std::find_if(items.begin(), items.end(),
                                  [&](const Named& item) { return item.name == name; });
  return found == items.end() ? nullptr : &*found;
}

/// What a segment of an action may do.
struct Licence {
  std::optional<std::string> from;  ///< the gait in which it begins, if known
  std::optional<std::string> to;    ///< the gait in which it ends, if known
  bool may_fly = false;
  /// Indices of patches that may bear; none: all.
  std::optional<std::set<int>> patches;
};

void AddPatches(const models::Gait& gait, std::set<int>* patches) {
  for (const models::GaitLimb& limb : gait.limbs) patches->insert(limb.contact);
}

/// Licence of a segment between two gaits of the robot.
Licence Between(const models::RobotModel& robot, const std::string& from, const std::string& to,
                bool may_fly) {
  Licence licence{from, to, may_fly, std::set<int>()};
  for (const std::string& name : {from, to}) {
    AddPatches(robot.GaitNamed(name), &*licence.patches);
  }
  return licence;
}

class ActionChecker {
 public:
  ActionChecker(const models::RobotModel& robot, const models::Scenario& scenario,
                ViolationLog* log)
      : robot_(robot), scenario_(scenario), log_(log) {}

  void Check(const Segment& segment, int index) {
    at_ = {index, segment.phases.front().knots.front().t};
    const std::optional<Licence> licence = LicenceOf(segment.action);
    if (!licence) {
      before_.reset();
      return;
    }
    if (before_ && licence->from && *before_ != *licence->from) {
      Report(fmt::format("'{}' begins in the gait '{}', the segment before it ends in '{}'",
                         segment.action, *licence->from, *before_));
    }
    before_ = licence->to;
    for (const Phase& phase : segment.phases) CheckPhase(phase, segment.action, *licence);
  }

 private:
  void Report(const std::string& quantity) { log_->Report(ViolationKind::kAction, at_, quantity); }

  bool IsAllowed(const std::string& action) {
    const std::vector<std::string>& allowed = scenario_.actions;
    if (allowed.empty()) return true;
    if (std::find(allowed.begin(), allowed.end(), action) != allowed.end()) return true;
    Report(fmt::format("'{}' is not among the scenario's actions", action));
    return false;
  }

  /// None, and a report, if the scenario does not allow such a segment.
  std::optional<Licence> LicenceOf(const std::string& text) {
    const std::optional<SegmentAction> action = ParseSegmentAction(text);
    if (!action) {
      Report(fmt::format("{:?} is no action, expected {}", text, models::kActionNameRule));
      return std::nullopt;
    }
    if (!IsAllowed(action->from) || !IsAllowed(action->to)) return std::nullopt;
    if (action->is_transition) return TransitionLicence(*action);
    if (FindNamed(robot_.gaits, action->from) != nullptr) {
      return Between(robot_, action->from, action->from, false);
    }
    if (const models::Jump* jump = FindNamed(robot_.jumps, action->from)) {
      return Between(robot_, jump->from, jump->to, true);
    }
    return Licence{{}, {}, true, {}};
  }

  std::optional<Licence> TransitionLicence(const SegmentAction& action) {
    const bool exists = std::any_of(robot_.transitions.begin(), robot_.transitions.end(),
                                    [&](const models::Transition& t) {
                                      return (t.from == action.from && t.to == action.to) ||
                                             (t.from == action.to && t.to == action.from);
                                    });
    if (!exists) {
      Report(
          fmt::format("the robot has no transition between '{}' and '{}'", action.from, action.to));
      return std::nullopt;
    }
    return Between(robot_, action.from, action.to, false);
  }

  void CheckPhase(const Phase& phase, const std::string& action, const Licence& licence) {
    at_.time = phase.knots.front().t;
    if (!licence.may_fly && phase.contacts.empty()) Report(fmt::format("'{}' flies", action));
    if (!licence.may_fly && phase.impulses.cols() > 0) {
      Report(fmt::format("'{}' hits the ground", action));
    }
    if (!licence.patches) return;
    for (const BearingPatch& bearing : BearingPatches(robot_, phase)) {
      if (licence.patches->contains(bearing.patch)) continue;
      Report(fmt::format("'{}' bears on {}, which is no part of it", action,
                         robot_.contacts[bearing.patch].name));
    }
  }

  const models::RobotModel& robot_;
  const models::Scenario& scenario_;
  ViolationLog* log_;
  Instant at_;
  std::optional<std::string> before_;  ///< last gait of the previous segment, if known
};

/// The root's horizontal path between two knots, in Bernstein form: it stays in the box of its
/// control points, and halving (de Casteljau) tightens the box.
struct RootPath {
  std::array<Vector2d, 6> points;
  double begin = 0;  ///< s
  double end = 0;

  RootPath(const Knot& k0, const Knot& k1) : begin(k0.t), end(k1.t) {
    const double h = end - begin;
    const auto xy = [](const Eigen::VectorXd& numbers, int first) {
      return Vector2d(numbers.segment<2>(first));
    };
    const Vector2d p0 = xy(k0.q, 4), v0 = h * xy(k0.v, 3), a0 = h * h * xy(k0.a, 3);
    const Vector2d p1 = xy(k1.q, 4), v1 = h * xy(k1.v, 3), a1 = h * h * xy(k1.a, 3);
    points = {p0, p0 + v0 / 5, p0 + 0.4 * v0 + a0 / 20, p1 - 0.4 * v1 + a1 / 20, p1 - v1 / 5, p1};
  }

  std::pair<RootPath, RootPath> Halves() const {
    RootPath first = *this;
    RootPath second = *this;
    first.end = second.begin = (begin + end) / 2;
    for (std::size_t step = 1; step < points.size(); ++step) {
      for (std::size_t i = 0; i + step < points.size(); ++i) {
        second.points[i] = (second.points[i] + second.points[i + 1]) / 2;
      }
      first.points[step] = second.points[0];
    }
    return {first, second};
  }
};

/// Finds the place where the root is farthest outside.
class FarthestOutside {
 public:
  explicit FarthestOutside(const Eigen::AlignedBox2d& bounds) : bounds_(bounds) {}

  void Look(const RootPath& path, int halvings = 0) {
    constexpr double kAccuracy = 1e-6;  // m
    constexpr int kMost = 30;
    Offer(path.points.front(), path.begin);
    Offer(path.points.back(), path.end);
    if (AtMost(path) <= std::max(distance_ + kAccuracy, kSway) || halvings == kMost) return;
    const auto [first, second] = path.Halves();
    Look(first, halvings + 1);
    Look(second, halvings + 1);
  }

  double distance() const { return distance_; }  ///< m
  double time() const { return time_; }          ///< s

 private:
  void Offer(const Vector2d& point, double time) {
    const double distance = bounds_.exteriorDistance(point);
    if (distance <= distance_) return;
    distance_ = distance;
    time_ = time;
  }

  double AtMost(const RootPath& path) const {
    Eigen::AlignedBox2d hull;
    for (const Vector2d& point : path.points) hull.extend(point);
    const Vector2d beyond =
        (bounds_.min() - hull.min()).cwiseMax(hull.max() - bounds_.max()).cwiseMax(0);
    return beyond.norm();
  }

  Eigen::AlignedBox2d bounds_;
  double distance_ = 0;
  double time_ = 0;
};

}  // namespace

void CheckActions(const Plan& plan, const models::RobotModel& robot,
                  const models::Scenario& scenario, ViolationLog* log) {
  ActionChecker checker(robot, scenario, log);
  for (std::size_t s = 0; s < plan.segments.size(); ++s) {
    checker.Check(plan.segments[s], static_cast<int>(s));
  }
}

void CheckBounds(const Plan& plan, const models::Scenario& scenario, ViolationLog* log) {
  const Eigen::AlignedBox2d& bounds = scenario.environment.bounds;
  if (bounds.isEmpty()) return;
  for (std::size_t s = 0; s < plan.segments.size(); ++s) {
    FarthestOutside farthest(bounds);
    for (const Phase& phase : plan.segments[s].phases) {
      for (std::size_t i = 0; i + 1 < phase.knots.size(); ++i) {
        farthest.Look(RootPath(phase.knots[i], phase.knots[i + 1]));
      }
    }
    log->RequireAtMost(ViolationKind::kBounds, {static_cast<int>(s), farthest.time()},
                       farthest.distance(), 0, kSway, "m",
                       [] { return std::string("root beyond the scenario's bounds"); });
  }
}

}  // namespace possibility::actions
