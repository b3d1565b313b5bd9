#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <random>

#include "actions/plan/plan.h"

namespace possibility::actions::testing {

/// A knot of random numbers at time t; the root quaternion is of unit length.
inline Knot RandomKnot(double t, int num_joints, int num_points, std::mt19937* generator) {
  std::normal_distribution<double> normal;
  const auto random = [&](int size) {
    Eigen::VectorXd x(size);
    for (double& value : x) value = normal(*generator);
    return x;
  };
  Knot knot;
  knot.t = t;
  knot.q = random(7 + num_joints);
  knot.q.head<4>().normalize();
  knot.v = random(6 + num_joints);
  knot.a = 10 * random(6 + num_joints);
  knot.tau = 50 * random(num_joints);
  const Eigen::VectorXd forces = 300 * random(3 * num_points);
  knot.forces = Eigen::Map<const Eigen::Matrix3Xd>(forces.data(), 3, num_points);
  return knot;
}

inline Eigen::Isometry3d RandomPose(std::mt19937* generator) {
  const Eigen::VectorXd q = RandomKnot(0, 0, 0, generator).q;
  Eigen::Isometry3d pose(Eigen::Quaterniond(q[0], q[1], q[2], q[3]));
  pose.translation() = q.tail<3>();
  return pose;
}

/// A plan that is valid in form only, with a flight and an impact. Its numbers mean nothing.
inline Plan RandomPlan(std::mt19937* generator) {
  Plan plan;
  plan.robot_file = "robot folder/robot.yaml";
  plan.robot_hash = "0123abcd";
  plan.scenario_file = "scenarios/hallway \"2\".yaml";
  plan.scenario_hash = "fedc9876";
  plan.seed = 18446744073709551615ull;
  plan.goal = 1;
  plan.timings = {0.25, 1.25, 0.5, 0.1, 0.7};
  plan.statistics = {{"vertices", 120}, {"smallest", INT64_MIN}, {"largest", INT64_MAX}};
  plan.joints = {"LHP", "LKP", "LAP"};
  double t = 0;
  for (int s = 0; s < 2; ++s) {
    Segment segment;
    segment.action = s == 0 ? "walk" : "walk->crawl";
    for (int p = 0; p < 2; ++p) {
      Phase phase;
      int num_points = 0;
      if (p == 0) {
        phase.contacts = {"left_sole", "right_sole"};
        num_points = 8;
      } else if (s == 1) {
        phase.contacts = {"left_sole[0,3]", "right_peg"};
        num_points = 3;
      }
      for (int k = 0; k < 3; ++k) {
        phase.knots.push_back(RandomKnot(t, 3, num_points, generator));
        if (k < 2) t += 0.1;
      }
      if (s == 1 && p == 1) phase.impulses = RandomKnot(t, 3, num_points, generator).forces;
      segment.phases.push_back(phase);
    }
    plan.segments.push_back(segment);
  }
  const Eigen::Isometry3d place = RandomPose(generator);
  plan.schedule = models::ContactSchedule{
      {"left_sole", "right_peg", "left_sole[0,3]"},
      {{0.2, {place, RandomPose(generator), std::nullopt}},
       {0.1, {place, std::nullopt, std::nullopt}},
       {0.1, {std::nullopt, RandomPose(generator), RandomPose(generator)}}}};
  plan.explored.vertices = {{{1, 2, 0.7}, 0.1}, {{1.5, 2, 0.7}, -0.2}};
  plan.explored.edges = {{0, 1, "walk"}};
  return plan;
}

}  // namespace possibility::actions::testing
