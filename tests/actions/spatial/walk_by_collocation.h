#pragma once

#include <string>

#include "actions/gait/foothold_plan.h"
#include "actions/motion/motion_schedule.h"
#include "actions/spatial/spatial_solver.h"
#include "tests/actions/drchubo1.h"
#include "tests/actions/standing_plan.h"

namespace possibility::actions {

/// DRC-HUBO1's walk straight ahead by collocation: legs and trunk, shoulders and elbows across the
/// sagittal plane; all other joints of the arms stay as they are.
struct WalkByCollocation {
  explicit WalkByCollocation(double way, double step) : distance(way) {
    const models::RobotModel& robot = DrcHubo1();
    schedule = ScheduleOf(robot, stance, groups, {},
                          PlanSteps(stance, groups, {{}, Goal()}, {step, 0.15, 0.3}),
                          {0.6, step, 0.12, 0.5});
    to[4] += distance;
    for (int j = 0; j < robot.num_joints(); ++j) {
      for (const std::string end : {"WY", "WP", "WR", "SR", "SY"}) {
        if (robot.joints[j].name.substr(1) == end) settings.problem.locked[j] = stance.q[7 + j];
      }
    }
  }

  SpatialSolution Solve(const CancellationToken& cancellation = {}) const {
    return SolveSpatialMotion(DrcHubo1(), *stance.gait, schedule, stance.q, to, settings,
                              cancellation);
  }

  /// The motion as a plan on a large floor.
  testing::VerifierSubject PlanOf(const SpatialSolution& solution) const {
    testing::VerifierSubject subject = testing::PlanWithoutMotion(DrcHubo1().file.string());
    subject.scenario.environment.obstacles[0].shape = models::Shape::Box({20, 20, 0.1});
    subject.scenario.environment.bounds =
        Eigen::AlignedBox2d(Eigen::Vector2d(-9, -9), Eigen::Vector2d(9, 9));
    subject.scenario.goals[0].x = distance;
    subject.plan.segments.push_back({"walk", solution.phases});
    subject.plan.schedule = ScheduleOfMotion(subject.robot, subject.plan.segments);
    return subject;
  }

  PlanarPose Goal() const { return {distance, 0, 0}; }

  double distance = 0;  ///< m
  NominalStance stance = SolveNominalStance(DrcHubo1(), DrcHubo1().GaitNamed("walk"));
  std::vector<std::vector<int>> groups = SwingGroups(stance);
  models::ContactSchedule schedule;
  Eigen::VectorXd to = stance.q;
  SpatialSolverSettings settings;
};

}  // namespace possibility::actions
