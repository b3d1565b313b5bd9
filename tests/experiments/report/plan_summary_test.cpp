#include "experiments/report/plan_summary.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "experiments/report/cost_of_transport.h"
#include "tests/experiments/sample_plan.h"

namespace possibility::experiments {
namespace {

actions::PlanResult Found() {
  actions::PlanResult result;
  result.status = actions::PlanStatus::kFound;
  result.plan = testing::SamplePlan(testing::SampleRobot(), 4, 9);
  return result;
}

TEST(PlanSummary, JoinsSegmentsOfTheSameAction) {
  actions::PlanResult result = Found();
  result.plan.segments[1].action = "walk";
  const std::vector<ActionSpan> legs = RouteByAction(result.plan);
  ASSERT_EQ(legs.size(), 1u);
  EXPECT_EQ(legs[0].action, "walk");
  EXPECT_EQ(legs[0].begin, 0);
  EXPECT_EQ(legs[0].duration, 4);
}

TEST(PlanSummary, RatioIsExecutionOverPlanningTime) {
  EXPECT_DOUBLE_EQ(*RealTimeRatio(Found().plan), 4 / (1.5 + 0.5));
  EXPECT_FALSE(RealTimeRatio(actions::Plan()).has_value());
}

TEST(PlanSummary, JsonOfAPlanNamesRouteAndFiles) {
  const auto json = nlohmann::json::parse(
      SummaryJson(Found(), testing::SampleRobot(), {"a/plan.json", "a/plan.html"}));
  EXPECT_EQ(json["status"], "found");
  EXPECT_FALSE(json.contains("no"));
  EXPECT_EQ(json["route"].size(), 2u);
  EXPECT_EQ(json["route"][1]["action"], "walk->crawl");
  EXPECT_EQ(json["route"][1]["begin_s"], 2.0);
  EXPECT_EQ(json["plan_duration_s"], 4.0);
  EXPECT_TRUE(json["path_length_m"].is_number());
  EXPECT_TRUE(json["speeds"].is_object());
  EXPECT_GT(json["cost_of_transport"], 0);
  EXPECT_EQ(json["cost_of_transport_by_action"].size(), json["speeds"].size());
  EXPECT_EQ(json["plan"], "a/plan.json");
  EXPECT_TRUE(json["verification"]["accepted"]);
}

TEST(PlanSummary, TextNamesCostsBesideSpeeds) {
  const actions::PlanResult result = Found();
  const models::RobotModel robot = testing::SampleRobot();
  const std::string text = SummaryText(result, robot, {"a/plan.json", "a/plan.html"});
  const std::string whole =
      fmt::format("; {:.2f} in all\n", CostOfTransport(robot, result.plan).value());
  EXPECT_NE(text.find("transport cost   walk "), std::string::npos) << text;
  EXPECT_NE(text.find(whole), std::string::npos) << text;
}

TEST(PlanSummary, JsonWithoutAPlanHoldsTheReasonAndTheFiles) {
  actions::PlanResult result;
  result.status = actions::PlanStatus::kExhausted;
  result.explanation = "the bars are too low";
  const auto json = nlohmann::json::parse(
      SummaryJson(result, testing::SampleRobot(), {"a/plan.json", "a/plan.html"}));
  EXPECT_EQ(json["status"], "no_plan");
  EXPECT_EQ(json["no"], "exhausted");
  EXPECT_EQ(json["explanation"], "the bars are too low");
  EXPECT_EQ(json["plan"], "a/plan.json");
  EXPECT_EQ(json["page"], "a/plan.html");
  EXPECT_FALSE(json.contains("route"));
}

}  // namespace
}  // namespace possibility::experiments
