#include "experiments/report/cost_of_transport.h"

#include <gtest/gtest.h>

#include <cmath>

#include "dynamics/tree/tree_kinematics.h"
#include "tests/experiments/sample_plan.h"

namespace possibility::experiments {
namespace {

constexpr double kDuration = 4;  // s, of a plan
constexpr double kTorque = 30;   // N m
constexpr double kRate = -0.5;   // rad/s
constexpr double kLength = 1.5;  // m, of either segment

/// "walk" and "walk->crawl" of 2 s and kLength each, with constant torque and rate of the one
/// joint.
actions::Plan SteadyPlan(const models::RobotModel& robot) {
  actions::Plan plan = testing::SamplePlan(robot, kDuration, 9);
  for (int s = 0; s < 2; ++s) {
    for (actions::Knot& knot : plan.segments[s].phases[0].knots) {
      knot.q.segment<2>(4) << knot.t / kDuration * 2 * kLength, 0;
      knot.v[6] = kRate;
      knot.tau[0] = kTorque;
    }
  }
  return plan;
}

TEST(CostOfTransport, OfOneJointOfConstantTorqueAndRateIsTheClosedForm) {
  const models::RobotModel robot = testing::SampleRobot();
  const actions::Plan plan = SteadyPlan(robot);
  const double work = std::abs(kTorque * kRate) * kDuration / 2;
  EXPECT_NEAR(MotorWork(robot, plan.segments[0]), work, 1e-9);
  const double cost = work / (robot.TotalMass() * dynamics::kGravity * kLength);
  EXPECT_NEAR(CostOfTransport(robot, plan).value(), cost, 1e-12);
  const auto costs = CostsOfTransportByAction(robot, plan);
  ASSERT_EQ(costs.size(), 2u);
  EXPECT_EQ(costs[1].first, "walk->crawl");
  EXPECT_NEAR(costs[1].second, cost, 1e-12);
}

TEST(CostOfTransport, CountsDrivingAndBraking) {
  const models::RobotModel robot = testing::SampleRobot();
  actions::Plan plan = SteadyPlan(robot);
  std::vector<actions::Knot>& knots = plan.segments[0].phases[0].knots;
  knots = {knots.front(), knots.back()};
  knots[0].v[6] = -1;
  knots[1].v[6] = 3;
  // Two triangles: 1 rad/s falling over a quarter of 2 s, then 3 rad/s rising.
  EXPECT_NEAR(MotorWork(robot, plan.segments[0]), kTorque * (0.5 * 1 * 0.5 + 0.5 * 3 * 1.5), 1e-9);
}

TEST(CostOfTransport, OfAMimicJointIsItsMotors) {
  models::RobotModel robot = testing::SampleRobot();
  robot.joints.push_back(robot.joints[0]);
  robot.joints[1].mimic = {0, 2, 0};
  actions::Segment segment;
  segment.phases.resize(1);
  for (const double t : {0.0, 1.0}) {
    actions::Knot knot;
    knot.t = t;
    knot.v = Eigen::VectorXd::Zero(8);
    knot.v.tail<2>() << 3, 6;
    knot.tau = Eigen::Vector2d(10, -4);
    segment.phases[0].knots.push_back(knot);
  }
  EXPECT_NEAR(MotorWork(robot, segment), (10 - 2 * 4) * 3, 1e-12);
}

TEST(CostOfTransport, OfAPlanThatLeadsNowhereIsNone) {
  const models::RobotModel robot = testing::SampleRobot();
  actions::Plan plan = SteadyPlan(robot);
  for (actions::Segment& segment : plan.segments) {
    for (actions::Knot& knot : segment.phases[0].knots) knot.q.segment<2>(4).setZero();
  }
  EXPECT_FALSE(CostOfTransport(robot, plan).has_value());
  EXPECT_FALSE(CostOfTransport(robot, {}).has_value());
  EXPECT_TRUE(CostsOfTransportByAction(robot, plan).empty());
}

}  // namespace
}  // namespace possibility::experiments
