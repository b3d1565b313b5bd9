#pragma once

#include <filesystem>

#include "actions/plan/plan.h"
#include "actions/plan/plan_writer.h"
#include "models/robot/robot_model.h"
#include "models/robot/robot_yaml.h"
#include "models/world/scenario.h"

namespace possibility::experiments::testing {

/// A plan of 1 s of the robot standing still at the scenario's start.
inline void WriteStandingPlan(const std::filesystem::path& scenario_file,
                              const std::filesystem::path& plan_file) {
  const models::Scenario scenario = models::LoadScenario(scenario_file);
  const models::RobotModel robot = models::LoadRobotModel(scenario.robot_file);
  actions::Plan plan;
  plan.robot_file = robot.file;
  plan.robot_hash = robot.content_hash;
  plan.scenario_file = scenario.file;
  plan.scenario_hash = scenario.content_hash;
  for (const models::Joint& joint : robot.joints) plan.joints.push_back(joint.name);
  actions::Phase phase;
  Eigen::Index num_points = 0;
  for (const models::GaitLimb& limb : robot.GaitNamed("walk").limbs) {
    phase.contacts.push_back(robot.contacts[limb.contact].name);
    num_points += static_cast<Eigen::Index>(robot.contacts[limb.contact].points.size());
  }
  for (const double t : {0.0, 0.5, 1.0}) {
    phase.knots.push_back({t,
                           robot.Configuration(robot.GaitNamed("walk").posture, scenario.start.x,
                                               scenario.start.y, scenario.start.yaw),
                           Eigen::VectorXd::Zero(robot.nv()), Eigen::VectorXd::Zero(robot.nv()),
                           Eigen::VectorXd::Zero(robot.num_joints()),
                           Eigen::Matrix3Xd::Zero(3, num_points)});
  }
  plan.segments = {{"walk", {phase}}};
  actions::WritePlan(plan, plan_file);
}

}  // namespace possibility::experiments::testing
