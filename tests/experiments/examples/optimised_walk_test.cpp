#include "experiments/examples/optimised_walk.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "actions/verify/verification_report.h"
#include "actions/verify/verifier.h"
#include "models/input/input_error.h"
#include "tests/actions/drchubo1.h"
#include "tests/experiments/read_text.h"

namespace possibility::actions {
namespace {

TEST(OptimisedWalkTest, AStepFromAnyStanceIsVerified) {
  models::Scenario scenario = models::LoadScenario(std::string(POSSIBILITY_SOURCE_DIR) +
                                                   "/experiments/examples/long_floor.yaml");
  scenario.start = {"walk", 1, 0.2, 0, 0.5};
  scenario.goals = {{"walk", 1 + 0.25 * std::cos(0.5), 0.2 + 0.25 * std::sin(0.5), 0, 0.5}};
  const Plan plan = OptimisedWalk(DrcHubo1(), scenario, 0.25);
  const VerificationReport report = Verify(plan, DrcHubo1(), scenario);
  EXPECT_TRUE(report.accepted()) << FormatText(report);
}

/// A scenario that starts at (1, 0.2), turned by 0.5 rad, and a goal beside its start.
models::Scenario WithGoal(double ahead, double aside, double turn) {
  models::Scenario scenario;
  scenario.start = {"walk", 1, 0.2, 0, 0.5};
  const double c = std::cos(0.5);
  const double s = std::sin(0.5);
  scenario.goals = {
      {"walk", 1 + c * ahead - s * aside, 0.2 + s * ahead + c * aside, 0, 0.5 + turn}};
  return scenario;
}

TEST(OptimisedWalkTest, TheDistanceToAGoalAheadIsMeasuredAlongTheHeading) {
  EXPECT_NEAR(DistanceAhead(WithGoal(2.8, 0, 0)), 2.8, 1e-12);
}

TEST(OptimisedWalkTest, AGoalThatIsNotStraightAheadIsRefused) {
  EXPECT_THROW(DistanceAhead(WithGoal(0, 0, 0)), InputError);
  EXPECT_THROW(DistanceAhead(WithGoal(-1, 0, 0)), InputError);
  EXPECT_THROW(DistanceAhead(WithGoal(1, 0.02, 0)), InputError);
  EXPECT_THROW(DistanceAhead(WithGoal(1, 0, 0.02)), InputError);
  models::Scenario crawls = WithGoal(1, 0, 0);
  crawls.goals.front().action = "crawl";
  EXPECT_THROW(DistanceAhead(crawls), InputError);
}

/// The code in the docs must be in the source, word for word.
TEST(OptimisedWalkTest, TheDocsQuoteTheSource) {
  const std::string source = POSSIBILITY_SOURCE_DIR;
  const std::string code =
      experiments::testing::ReadText(source + "/experiments/examples/optimised_walk.cpp");
  const std::string begin = "  // Which foot bears";
  const std::string end = "stance.q, end, settings);\n";
  const std::size_t from = code.find(begin);
  ASSERT_NE(from, std::string::npos);
  const std::string quote = code.substr(from, code.find(end) + end.size() - from);
  EXPECT_NE(experiments::testing::ReadText(source + "/docs/collocation.md").find(quote),
            std::string::npos);
}

}  // namespace
}  // namespace possibility::actions
