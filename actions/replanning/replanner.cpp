#include "actions/replanning/replanner.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "actions/verify/verifier.h"
#include "common/cancellation_token.h"
#include "common/deadline.h"

namespace possibility::actions {
namespace {

/// Least time allowed for the verification of the last plan, s, as for that of a new one.
constexpr double kLeastToVerify = 10;

/// The goal that a plan ends closest to: its number may change, and goals may come and go.
int GoalOf(const Plan& plan, const std::vector<models::Stance>& goals) {
  const Eigen::Vector2d end = plan.segments.back().phases.back().knots.back().q.segment<2>(4);
  const auto distance = [&](const models::Stance& goal) {
    return (Eigen::Vector2d(goal.x, goal.y) - end).norm();
  };
  const auto closest =
      std::min_element(goals.begin(), goals.end(),
                       [&](const auto& a, const auto& b) { return distance(a) < distance(b); });
  return static_cast<int>(closest - goals.begin());
}

/// The last plan as an answer for another version of its scenario. Nothing of the old search is
/// said to hold in the new world.
Plan Readdressed(Plan plan, const models::RobotModel& robot, const models::Scenario& scenario,
                 const PlanRequest& request) {
  plan.robot_file = robot.file;
  plan.scenario_file = scenario.file;
  plan.scenario_hash = scenario.content_hash;
  plan.seed = request.seed;
  plan.goal = GoalOf(plan, scenario.goals);
  plan.timings = {};
  plan.statistics.clear();
  if (plan.search) plan.search->lower_bound = 0;
  return plan;
}

}  // namespace

std::optional<PlanResult> Replanner::LastPlanIn(const models::RobotModel& robot,
                                                const models::Scenario& scenario,
                                                const PlanRequest& request) {
  const bool may_do =
      last_ && last_->robot_hash == robot.content_hash && last_->version == request.plan_version;
  if (!may_do) return std::nullopt;
  models::Scenario asked = scenario;
  if (!request.actions.empty()) asked.actions = request.actions;
  PlanResult result;
  result.plan = Readdressed(*last_, robot, scenario, request);
  VerifierSettings settings;
  settings.threads = request.threads;
  settings.store = &memory_.verdicts();
  settings.cancellation = CancellationToken(
      [deadline = Deadline(std::max(request.time_limit, kLeastToVerify)),
       asked = request.cancellation] { return !deadline.Passed() && asked.Proceed(); });
  if (request.progress) {
    settings.progress = [&](double fraction) { request.progress({"verifying", {}, fraction}); };
  }
  result.verification = Verify(result.plan, robot, asked, settings);
  result.plan.timings.verification_s = result.verification.seconds;
  request.cancellation.ThrowIfCancelled();
  if (!result.verification.accepted()) return std::nullopt;
  result.status = PlanStatus::kFound;
  return result;
}

PlanResult Replanner::Plan(const models::RobotModel& robot, const models::Scenario& scenario,
                           PlanRequest request) {
  request.memory = &memory_;
  reuse_ = {};
  std::optional<PlanResult> kept = LastPlanIn(robot, scenario, request);
  if (kept) {
    reuse_ = {true, true};
    last_ = kept->plan;
    return std::move(*kept);
  }
  reuse_.model = last_robot_ == robot.content_hash;
  PlanResult result = PlanTraversal(robot, scenario, request);
  last_robot_ = robot.content_hash;
  if (result.status == PlanStatus::kFound) last_ = result.plan;
  return result;
}

}  // namespace possibility::actions
