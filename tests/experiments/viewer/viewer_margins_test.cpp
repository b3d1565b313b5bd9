#include "experiments/viewer/viewer_margins.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "actions/verify/plan_margins.h"
#include "experiments/recording/headless_browser.h"
#include "experiments/viewer/viewer_page.h"
#include "tests/actions/drchubo1.h"
#include "tests/actions/hop_plan.h"
#include "tests/experiments/sample_plan.h"
#include "tests/experiments/viewer/page_data.h"

namespace possibility::experiments {
namespace {

constexpr int kCount = 7;

/// The worst that a page shows of every margin, in the order of FrameMargins::Numbers.
std::vector<double> WorstOfPage(const testing::PageMotion& motion) {
  std::vector<double> worst(kCount, NAN);
  for (std::size_t i = 0; i < motion.margins.size(); ++i) {
    const bool is_distance = i % kCount < 4;
    double& value = worst[i % kCount];
    value = is_distance ? std::fmin(value, motion.margins[i]) : std::fmax(value, motion.margins[i]);
  }
  return worst;
}

std::vector<actions::Margin> InOrder(const actions::PlanMargins& margins) {
  return {margins.zmp,    margins.ground_edge, margins.self_distance, margins.obstacle_distance,
          margins.torque, margins.friction,    margins.joint_speed};
}

/// Returns how many margins were compared.
int CompareWithVerifier(const actions::Plan& plan, const models::RobotModel& robot,
                        const models::Scenario& scenario) {
  const testing::PageMotion motion(testing::EmbeddedData(ViewerPage(plan, robot, scenario)));
  const std::vector<double> shown = WorstOfPage(motion);
  const models::GroundMap ground(scenario.environment, robot.friction);
  const auto margins = InOrder(actions::MeasureMargins(plan, robot, scenario.environment, ground));
  int compared = 0;
  for (int i = 0; i < kCount; ++i) {
    EXPECT_EQ(std::isnan(shown[i]), margins[i].segment < 0) << i;
    if (margins[i].segment < 0) continue;
    EXPECT_NEAR(shown[i], margins[i].value, i < 4 ? 6e-6 : 6e-5) << i;
    ++compared;
  }
  return compared;
}

models::Scenario Yard() {
  models::Scenario scenario = testing::SampleScenario();
  scenario.environment.obstacles[0].X_WO.translation().z() = -0.05;
  scenario.environment.obstacles[1].X_WO.translation() << 0.5, 0.2, 0.5;
  return scenario;
}

TEST(FrameMarginsTest, TheWorstThatAPageShowsOfAHopIsTheVerifiersMargin) {
  const models::RobotModel& robot = actions::DrcHubo1();
  actions::Plan plan;
  plan.segments = {actions::testing::Hop(robot).Build()};
  EXPECT_EQ(CompareWithVerifier(plan, robot, Yard()), kCount);
}

/// The page keeps one knot of twenty.
TEST(FrameMarginsTest, NoPeakIsLostBetweenTheKnotsOfThePage) {
  models::RobotModel robot = testing::SampleRobot();
  robot.joints[0].velocity = 2;
  robot.joints[0].effort = 20;
  actions::Plan plan = testing::SamplePlan(robot, 4, 2001);
  plan.segments[0].phases[0].knots[777].v[6] = 1.9;
  plan.segments[1].phases[0].knots[1234].tau[0] = -19;
  EXPECT_GE(CompareWithVerifier(plan, robot, Yard()), 4);
  const testing::PageMotion motion(testing::EmbeddedData(ViewerPage(plan, robot, Yard())));
  EXPECT_LT(motion.margins.size(), 110u * kCount);
  EXPECT_NEAR(WorstOfPage(motion)[6], 0.95, 1e-4);
  EXPECT_NEAR(WorstOfPage(motion)[4], 0.95, 1e-4);
}

/// The plot of torques and the margin of torque agree on what a motor can do at a speed.
TEST(FrameMarginsTest, ThePlotOfTorquesKnowsTheLinesOfMotors) {
  if (!FindProgram({"chromium", "chromium-browser", "google-chrome"})) {
    GTEST_SKIP() << "chromium is not installed";
  }
  models::RobotModel robot = testing::SampleRobot();
  models::Joint& joint = robot.joints[0];
  joint.effort = 20;
  joint.actuator.line = models::TorqueSpeedLine{30, 4};
  HeadlessBrowser browser({600, 400});
  const std::string page = ViewerPage(testing::SamplePlan(robot, 4, 9), robot, Yard());
  const std::string embedded = testing::EmbeddedData(page)["joints"][0].dump();
  browser.Open(page, "#t=1&plots=1");
  if (browser.Evaluate("page === null") == true) GTEST_SKIP() << "chromium has no WebGL here";
  for (const double torque : {-15.0, 15.0}) {
    for (const double rate : {-5.0, -3.0, -0.5, 0.0, 0.5, 3.0}) {
      const double limit = joint.actuator.Limit(joint.effort, torque, rate);
      const double shown =
          browser.Evaluate(fmt::format("shareOfTorque({}, {}, {})", embedded, torque, rate));
      const double share = limit > 0 ? torque / limit : std::copysign(10, torque);
      EXPECT_NEAR(shown, 100 * std::clamp(share, -10.0, 10.0), 1e-6) << torque << " at " << rate;
    }
  }
}

TEST(FrameMarginsTest, FlightHasNoneOfTheGround) {
  const models::RobotModel& robot = actions::DrcHubo1();
  const models::Scenario scenario = Yard();
  const actions::Segment hop = actions::testing::Hop(robot).Build();
  const actions::Phase& flight = hop.phases[1];
  ASSERT_TRUE(flight.contacts.empty());
  const FrameMargins::Numbers margins =
      FrameMargins(robot, scenario.environment).Worst(flight, 0, flight.knots.size() - 1);
  for (const int i : {0, 1, 5}) EXPECT_TRUE(std::isnan(margins[i])) << i;
  for (const int i : {2, 3, 4, 6}) EXPECT_FALSE(std::isnan(margins[i])) << i;
}

}  // namespace
}  // namespace possibility::experiments
