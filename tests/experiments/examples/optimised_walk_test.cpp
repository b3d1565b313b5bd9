#include "experiments/examples/optimised_walk.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "actions/verify/verification_report.h"
#include "actions/verify/verifier.h"
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
