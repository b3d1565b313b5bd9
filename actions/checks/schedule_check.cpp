#include "actions/checks/schedule_check.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>
#include <string>

#include "actions/plan/contact_name.h"

namespace possibility::actions {
namespace {

using Eigen::Isometry3d;

constexpr double kTimeTolerance = 1e-6;   // s
constexpr double kPlaceTolerance = 1e-3;  // m, as of bearing points

/// Walks through the intervals of a schedule as the phases go by.
class ScheduleWalk {
 public:
  ScheduleWalk(const models::ContactSchedule& schedule, const models::RobotModel& robot,
               StateEvaluator* evaluator, ViolationLog* log)
      : schedule_(schedule),
        robot_(robot),
        evaluator_(evaluator),
        log_(log),
        end_(schedule.intervals.front().duration) {}

  void Follow(const Phase& phase, int segment) {
    const double begin = phase.knots.front().t;
    while (end_ <= begin + kTimeTolerance && interval_ + 1 < schedule_.intervals.size()) {
      end_ += schedule_.intervals[++interval_].duration;
    }
    const Instant at{segment, begin};
    if (phase.knots.back().t > end_ + kTimeTolerance) {
      log_->Report(ViolationKind::kSchedule, at,
                   fmt::format("contacts change at {:.6g} s in the schedule, not at {:.6g} s", end_,
                               phase.knots.back().t));
      return;
    }
    if (!HasSameContacts(phase, at)) return;
    CheckPlaces(phase, phase.knots.front(), at);
    CheckPlaces(phase, phase.knots.back(), {segment, phase.knots.back().t});
  }

  void RequireEnd(double end, int segment) {
    const double planned = schedule_.duration();
    if (std::abs(planned - end) <= kTimeTolerance) return;
    log_->Report(ViolationKind::kSchedule, {segment, end},
                 fmt::format("the schedule lasts {:.6g} s, the motion {:.6g} s", planned, end));
  }

 private:
  bool HasSameContacts(const Phase& phase, const Instant& at) {
    const models::ContactInterval& interval = schedule_.intervals[interval_];
    std::set<std::string> planned;
    for (std::size_t i = 0; i < schedule_.contacts.size(); ++i) {
      if (interval.bearing[i]) planned.insert(schedule_.contacts[i]);
    }
    const std::set<std::string> bearing(phase.contacts.begin(), phase.contacts.end());
    if (planned == bearing) return true;
    log_->Report(ViolationKind::kSchedule, at,
                 fmt::format("the motion bears with {}, the schedule with {}", Listed(bearing),
                             Listed(planned)));
    return false;
  }

  static std::string Listed(const std::set<std::string>& contacts) {
    return contacts.empty() ? "nothing" : fmt::format("{}", fmt::join(contacts, ", "));
  }

  void CheckPlaces(const Phase& phase, const Knot& knot, const Instant& at) {
    const VerifierState state = evaluator_->Evaluate(knot);
    const std::vector<BearingPatch> patches = BearingPatches(robot_, phase);
    for (std::size_t i = 0; i < patches.size(); ++i) {
      const models::ContactPatch patch = PatchOf(robot_, patches[i]);
      const double away = Away(patch, state.X_WL[patch.link], PlaceOf(phase.contacts[i]));
      log_->RequireAtMost(ViolationKind::kSchedule, at, away, 0, kPlaceTolerance, "m", [&] {
        return phase.contacts[i] + " away from its place in the schedule";
      });
    }
  }

  const Isometry3d& PlaceOf(const std::string& contact) const {
    const auto found = std::find(schedule_.contacts.begin(), schedule_.contacts.end(), contact);
    return *schedule_.intervals[interval_].bearing[found - schedule_.contacts.begin()];
  }

  /// Greatest distance of a point from its place, m; of the centre if the points do not hold an
  /// orientation.
  static double Away(const models::ContactPatch& patch, const Isometry3d& X_WL,
                     const Isometry3d& X_WP) {
    if (patch.points.size() < 3) return (X_WL * patch.Centre() - X_WP.translation()).norm();
    const Isometry3d planned = X_WP * patch.Frame().inverse();
    double away = 0;
    for (const Eigen::Vector3d& point : patch.points) {
      away = std::max(away, (X_WL * point - planned * point).norm());
    }
    return away;
  }

  const models::ContactSchedule& schedule_;
  const models::RobotModel& robot_;
  StateEvaluator* evaluator_;
  ViolationLog* log_;
  std::size_t interval_ = 0;
  double end_;  ///< s, of the interval
};

}  // namespace

void CheckSchedule(const Plan& plan, const models::RobotModel& robot, StateEvaluator* evaluator,
                   ViolationLog* log) {
  if (!plan.schedule) return;
  try {
    models::CheckContactSchedule(*plan.schedule);
  } catch (const std::invalid_argument& error) {
    log->Report(ViolationKind::kSchedule, {}, error.what());
    return;
  }
  ScheduleWalk walk(*plan.schedule, robot, evaluator, log);
  for (std::size_t s = 0; s < plan.segments.size(); ++s) {
    for (const Phase& phase : plan.segments[s].phases) walk.Follow(phase, static_cast<int>(s));
  }
  walk.RequireEnd(plan.segments.back().phases.back().knots.back().t,
                  static_cast<int>(plan.segments.size()) - 1);
}

}  // namespace possibility::actions
