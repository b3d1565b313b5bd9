#pragma once

#include <cmath>
#include <string>

#include "actions/plan/plan.h"
#include "models/robot/robot_model.h"
#include "models/world/scenario.h"

namespace possibility::experiments::testing {

/// A box on one hinged leg with a foot of four points and a peg of one.
inline models::RobotModel SampleRobot() {
  models::RobotModel robot;
  robot.name = "hopper";
  robot.links.resize(2);
  robot.links[0] = {"trunk", {1, Eigen::Vector3d::Zero(), Eigen::Matrix3d::Identity()}, {}};
  robot.links[1] = {"leg", {1, Eigen::Vector3d::Zero(), Eigen::Matrix3d::Identity()}, {}};
  robot.links[0].shapes = {{models::Shape::Box({0.3, 0.2, 0.4}), Eigen::Isometry3d::Identity()}};
  robot.links[1].shapes = {{models::Shape::Capsule(0.05, 0.5), Eigen::Isometry3d::Identity()}};
  models::Joint hip;
  hip.name = "hip";
  hip.axis = Eigen::Vector3d::UnitY();
  hip.X_PJ.translation() = Eigen::Vector3d(0, 0, -0.2);
  robot.joints = {hip};
  robot.contacts = {
      {"sole", 1, {{0.1, 0.1, -0.3}, {-0.1, 0.1, -0.3}, {-0.1, -0.1, -0.3}, {0.1, -0.1, -0.3}}},
      {"peg", 0, {{0.2, 0, 0}}}};
  return robot;
}

inline models::Scenario SampleScenario() {
  models::Scenario scenario;
  scenario.name = "yard";
  models::Obstacle floor;
  floor.name = "floor";
  floor.shape = models::Shape::Box({4, 4, 0.1});
  floor.is_ground = true;
  models::Obstacle bar;
  bar.name = "bar";
  bar.shape = models::Shape::Cylinder(0.02, 1);
  scenario.environment.obstacles = {floor, bar};
  scenario.environment.bounds = Eigen::AlignedBox2d(Eigen::Vector2d(-2, -2), Eigen::Vector2d(2, 2));
  scenario.goals = {models::Stance{"walk", 1, 0.5, 0, 0}};
  return scenario;
}

/// A smooth motion with irrational numbers, so that rounding is visible.
inline actions::Knot SampleKnot(const models::RobotModel& robot, double t, int num_points) {
  actions::Knot knot;
  knot.t = t;
  knot.q = Eigen::VectorXd::Constant(robot.nq(), 0.3 * std::sin(t));
  knot.q.head<4>() << std::cos(t / 20), 0, 0, std::sin(t / 20);
  knot.v = Eigen::VectorXd::Constant(robot.nv(), 0.3 * std::cos(t));
  knot.a = Eigen::VectorXd::Constant(robot.nv(), -0.3 * std::sin(t));
  knot.tau = Eigen::VectorXd::Constant(robot.num_joints(), 10 * std::exp(-t));
  knot.forces = Eigen::Matrix3Xd::Constant(3, num_points, 100.0 / 3 + t);
  return knot;
}

/// Two segments, "walk" on the sole and "walk->crawl" on sole and peg, of `duration` / 2 each.
inline actions::Plan SamplePlan(const models::RobotModel& robot, double duration, int num_knots) {
  actions::Plan plan;
  for (const models::Joint& joint : robot.joints) plan.joints.push_back(joint.name);
  plan.segments = {{"walk", {{{"sole"}, {}}}}, {"walk->crawl", {{{"sole", "peg"}, {}}}}};
  for (int s = 0; s < 2; ++s) {
    for (int k = 0; k < num_knots; ++k) {
      const double t = (s + static_cast<double>(k) / (num_knots - 1)) * duration / 2;
      plan.segments[s].phases[0].knots.push_back(SampleKnot(robot, t, s == 0 ? 4 : 5));
    }
  }
  plan.explored.vertices.resize(3);
  plan.explored.edges = {{0, 1, "walk"}, {1, 2, "crawl"}, {0, 2, "walk"}};
  plan.timings.graph_s = 1.5;
  plan.timings.motion_s = 0.5;
  return plan;
}

}  // namespace possibility::experiments::testing
