// Pages of plans with thousands of steps.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "experiments/viewer/viewer_page.h"
#include "tests/experiments/sample_plan.h"
#include "tests/experiments/viewer/browser.h"

namespace possibility::experiments {
namespace {

constexpr double kStep = 1;  // s

/// Steps of a second on the sole, with a flight between each two, 0.1 m apart.
actions::Plan Steps(const models::RobotModel& robot, int count) {
  actions::Plan plan;
  plan.joints = {robot.joints[0].name};
  for (int i = 0; i < count; ++i) {
    actions::Segment step{"hop", {{{"sole"}, {}}, {{}, {}}}};
    for (int k = 0; k <= 20; ++k) {
      actions::Phase& phase = step.phases[k < 11 ? 0 : 1];
      const double t = kStep * (i + (k < 11 ? k : k - 1) / 19.0);
      actions::Knot knot = testing::SampleKnot(robot, t, k < 11 ? 4 : 0);
      knot.q[4] = 0.1 * t;
      phase.knots.push_back(knot);
    }
    plan.segments.push_back(step);
  }
  return plan;
}

class PageOfALongPlan : public testing::BrowserTest {
 protected:
  /// What an expression says once the page of a plan has run.
  std::string Asked(int steps, const std::string& address, const std::string& expression) {
    const models::RobotModel robot = testing::SampleRobot();
    WritePage(ViewerPage(Steps(robot, steps), robot, testing::SampleScenario()));
    document_ = Opened(address, fmt::format("if (page) setTimeout(() => document.body.setAttribute("
                                            "'data-answer', {}), 500)",
                                            expression));
    return Between(document_, "data-answer=\"", "\"");
  }

  std::string document_;
};

TEST_F(PageOfALongPlan, ATimeInTheMiddleShowsTheRobotThere) {
  const std::string answer =
      Asked(3600, "#t=1800.421052631&plots=1",
            "[page.time.toFixed(3), page.views[0].motion.linkPoses[0].elements[12].toFixed(4), "
            "page.views[0].motion.phases.length, element('plots-title').textContent].join(' ')");
  if (!HasWebGl(document_)) GTEST_SKIP() << "chromium has no WebGL here";
  EXPECT_EQ(answer, "1800.421 180.0421 7200 hop, segment 1801 of 3600: 1800.00 to 1801.00 s");
}

/// The card draws what lies on the ground at once, however many steps there are.
TEST_F(PageOfALongPlan, MoreStepsAreNoMoreThingsToDraw) {
  const std::string count =
      "[page.views[0].drawing.renderer.info.render.calls, "
      "page.views[0].drawing.renderer.info.render.triangles].join(' ')";
  const std::string some = Asked(100, "#view=top", count);
  if (!HasWebGl(document_)) GTEST_SKIP() << "chromium has no WebGL here";
  const std::string many = Asked(1600, "#view=top", count);
  const auto parts = [](const std::string& text) {
    return std::pair(std::atoi(text.c_str()), std::atoi(text.c_str() + text.find(' ')));
  };
  EXPECT_GT(parts(some).first, 5) << some;
  EXPECT_EQ(parts(many).first, parts(some).first) << many;
  // Sixteen times as many footprints and flights, but the route is drawn in wider steps.
  EXPECT_LT(parts(many).second, 16 * parts(some).second) << some << ", " << many;
}

/// A segment of 40 minutes has 50 knots for every pixel of a plot.
TEST_F(PageOfALongPlan, APlotOfManyKnotsHasFewPointsAndAllPeaks) {
  models::RobotModel robot = testing::SampleRobot();
  actions::Plan plan = testing::SamplePlan(robot, 2400, 24001);
  plan.segments[1].phases[0].knots[7777].tau[0] = 190;
  robot.joints[0].effort = 200;
  WritePage(ViewerPage(plan, robot, testing::SampleScenario()));
  const std::string document =
      Opened("#t=1800&plots=1",
             "if (page) { const lines = page.plots[0].plots.shares.lines[0][0];"
             "document.body.setAttribute('data-answer', [lines.length < 2500, "
             "page.plots[0].phases[0].count "
             "> 20000, Math.max(...lines.map(([t, value]) => value)).toFixed(1)].join(' ')); }");
  if (!HasWebGl(document)) GTEST_SKIP() << "chromium has no WebGL here";
  EXPECT_EQ(Between(document, "data-answer=\"", "\""), "true true 95.0");
}

}  // namespace
}  // namespace possibility::experiments
