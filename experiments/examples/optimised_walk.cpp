#include "experiments/examples/optimised_walk.h"

#include <fmt/format.h>

#include <cmath>

#include "actions/gait/foothold_plan.h"
#include "actions/motion/motion_schedule.h"
#include "actions/motion/phase_sequence.h"
#include "actions/spatial/spatial_solver.h"
#include "actions/wholebody/planar_pose.h"
#include "models/input/input_error.h"

namespace possibility::actions {

double DistanceAhead(const models::Scenario& scenario) {
  const models::Stance& start = scenario.start;
  const models::Stance& goal = scenario.goals.front();
  const double dx = goal.x - start.x;
  const double dy = goal.y - start.y;
  const double ahead = std::cos(start.yaw) * dx + std::sin(start.yaw) * dy;
  const double aside = std::cos(start.yaw) * dy - std::sin(start.yaw) * dx;
  const double up = goal.z - start.z;
  const double turn = WrapAngle(goal.yaw - start.yaw);
  const bool stands = start.action == "walk" && goal.action == "walk";
  if (!stands || ahead < 0.01 || std::abs(aside) > 0.01 || std::abs(up) > 0.01 ||
      std::abs(turn) > 0.01) {
    throw InputError(fmt::format(
        "{}: the goal ({}) is {:.3g} m ahead of the start ({}), {:.3g} m to its left, {:.3g} m "
        "above "
        "it and turned by {:.3g} rad; this example walks straight ahead by 0.01 m or more",
        scenario.file.string(), goal.action, ahead, start.action, aside, up, turn));
  }
  return ahead;
}

Plan OptimisedWalk(const models::RobotModel& robot, const models::Scenario& scenario,
                   double distance) {
  // Which foot bears where and when: steps of at most 0.4 m, each swing about 0.6 s.
  const NominalStance stance = SolveNominalStance(robot, robot.GaitNamed("walk"));
  const auto feet = SwingGroups(stance);
  const auto steps = PlanSteps(stance, feet, {{}, {distance, 0, 0}}, {0.4, 0.15, 0.3});
  const StepTiming timing{.swing = 0.6, .swing_length = 0.4, .double_support = 0.12, .start = 0.5};
  const models::ContactSchedule schedule = ScheduleOf(robot, stance, feet, {}, steps, timing);

  // From rest to rest. Wrists and the other arm joints out of the sagittal plane stay as they are.
  Eigen::VectorXd end = stance.q;
  end[4] += distance;
  SpatialSolverSettings settings;
  for (int j = 0; j < robot.num_joints(); ++j) {
    const std::string name = robot.joints[j].name.substr(1);
    for (const std::string still : {"SR", "SY", "WY", "WP", "WR"}) {
      if (name == still) settings.problem.locked[j] = stance.q[7 + j];
    }
  }
  const SpatialSolution walk =
      SolveSpatialMotion(robot, *stance.gait, schedule, stance.q, end, settings);

  Plan plan;
  plan.robot_file = robot.file;
  plan.robot_hash = robot.content_hash;
  plan.scenario_file = scenario.file;
  plan.scenario_hash = scenario.content_hash;
  for (const models::Joint& joint : robot.joints) plan.joints.push_back(joint.name);
  const models::Stance& start = scenario.start;
  plan.segments = {{"walk", Placed(walk.phases, {start.x, start.y, start.yaw}, start.z)}};
  plan.schedule = ScheduleOfMotion(robot, plan.segments);
  return plan;
}

}  // namespace possibility::actions
