#include "experiments/report/plan_speeds.h"

#include <gtest/gtest.h>

#include "tests/experiments/sample_plan.h"

namespace possibility::experiments {
namespace {

/// Two segments of 2 s: "walk" over 5 m and "walk->crawl" over 1 m, with sway.
actions::Plan SwayingPlan() {
  const models::RobotModel robot = testing::SampleRobot();
  actions::Plan plan = testing::SamplePlan(robot, 4, 5);
  const std::pair<double, double> corners[] = {{0, 0}, {3, 4}, {3, 5}};
  for (int s = 0; s < 2; ++s) {
    auto& knots = plan.segments[s].phases[0].knots;
    for (std::size_t k = 0; k < knots.size(); ++k) {
      const double share = static_cast<double>(k) / static_cast<double>(knots.size() - 1);
      const double sway = k == 0 || k + 1 == knots.size() ? 0 : 0.1 * (k % 2 == 0 ? 1 : -1);
      const auto [x0, y0] = corners[s];
      const auto [x1, y1] = corners[s + 1];
      knots[k].q.segment<2>(4) << x0 + share * (x1 - x0) + sway, y0 + share * (y1 - y0);
    }
  }
  return plan;
}

TEST(PlanSpeeds, LengthIsMeasuredBetweenTheEndsOfSegments) {
  EXPECT_NEAR(PlanarLength(SwayingPlan()), 5 + 1, 1e-12);
  EXPECT_EQ(PlanarLength({}), 0);
}

TEST(PlanSpeeds, AreMeansOverTheSegmentsOfAnAction) {
  actions::Plan plan = SwayingPlan();
  auto speeds = SpeedsByAction(plan);
  ASSERT_EQ(speeds.size(), 2u);
  EXPECT_EQ(speeds[0].first, "walk");
  EXPECT_NEAR(speeds[0].second, 5.0 / 2, 1e-12);
  EXPECT_EQ(speeds[1].first, "walk->crawl");
  EXPECT_NEAR(speeds[1].second, 1.0 / 2, 1e-12);
  plan.segments[1].action = "walk";
  speeds = SpeedsByAction(plan);
  ASSERT_EQ(speeds.size(), 1u);
  EXPECT_NEAR(speeds[0].second, 6.0 / 4, 1e-12);
}

TEST(PlanSpeeds, LeaveOutWhatLeadsNowhere) {
  actions::Plan plan = SwayingPlan();
  for (actions::Knot& knot : plan.segments[1].phases[0].knots) knot.q.segment<2>(4).setZero();
  ASSERT_EQ(SpeedsByAction(plan).size(), 1u);
  EXPECT_TRUE(SpeedsByAction({}).empty());
}

}  // namespace
}  // namespace possibility::experiments
