#include "experiments/imports/imported_plan.h"

#include <fmt/format.h>

#include <algorithm>

#include "actions/motion/motion_schedule.h"
#include "actions/plan/plan_rounding.h"
#include "actions/plan/segment_action.h"
#include "experiments/imports/motion_completion.h"
#include "models/input/input_error.h"
#include "models/world/ground_map.h"

namespace possibility::experiments {
namespace {

int NearestGoal(const Eigen::Vector2d& end, const models::Scenario& scenario) {
  const auto distance = [&](const models::Stance& goal) {
    return (Eigen::Vector2d(goal.x, goal.y) - end).norm();
  };
  const auto nearest = std::min_element(
      scenario.goals.begin(), scenario.goals.end(),
      [&](const models::Stance& a, const models::Stance& b) { return distance(a) < distance(b); });
  return static_cast<int>(nearest - scenario.goals.begin());
}

std::vector<std::string> ActionsOf(const ImportedTrajectory& trajectory,
                                   const models::Scenario& scenario) {
  if (trajectory.actions.empty()) return {scenario.start.action};
  for (const std::string& action : trajectory.actions) {
    if (actions::ParseSegmentAction(action)) continue;
    throw InputError(fmt::format("{}: action '{}', expected a name or two with '->' between",
                                 trajectory.file.string(), action));
  }
  return trajectory.actions;
}

}  // namespace

actions::Plan ImportPlan(const ImportedTrajectory& trajectory, const models::RobotModel& robot,
                         const models::Scenario& scenario) {
  const models::GroundMap ground(scenario.environment, robot.friction);
  actions::Plan plan;
  plan.robot_file = robot.file;
  plan.robot_hash = robot.content_hash;
  plan.scenario_file = scenario.file;
  plan.scenario_hash = scenario.content_hash;
  plan.seed = scenario.seed;
  for (const models::Joint& joint : robot.joints) plan.joints.push_back(joint.name);
  plan.segments = CompleteMotion(trajectory, ActionsOf(trajectory, scenario), robot, ground);
  actions::RoundToPlanDigits(&plan);
  plan.schedule = actions::ScheduleOfMotion(robot, plan.segments);
  plan.goal = NearestGoal(trajectory.samples.back().q.segment<2>(4), scenario);
  return plan;
}

}  // namespace possibility::experiments
