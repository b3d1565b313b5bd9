// `plan --anytime` as its users run it.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "tests/experiments/program_run.h"

namespace possibility::experiments {
namespace {

using PlanAnytimeProgram = testing::ProgramRun;

const std::string kScenario =
    std::string("'") + POSSIBILITY_SOURCE_DIR + "/experiments/scenarios/crack.yaml'";

TEST_F(PlanAnytimeProgram, PrintsAnObjectForEachPlanAndKeepsTheLast) {
  const Outcome outcome =
      Run("plan " + kScenario + " --anytime --time-limit 8 --threads 1 --json --out out");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  std::vector<nlohmann::json> plans;
  std::istringstream lines(outcome.out);
  for (std::string line; std::getline(lines, line);) plans.push_back(nlohmann::json::parse(line));
  ASSERT_FALSE(plans.empty());
  for (std::size_t i = 0; i < plans.size(); ++i) {
    const nlohmann::json& anytime = plans[i]["anytime"];
    EXPECT_EQ(plans[i]["status"], "found");
    EXPECT_GT(anytime["least_duration_s"], 0);
    EXPECT_LE(anytime["least_duration_s"], plans[i]["plan_duration_s"]);
    EXPECT_GE(anytime["gap"], 0);
    EXPECT_LT(anytime["gap"], 1);
    if (i > 0) {
      EXPECT_LT(plans[i]["plan_duration_s"], plans[i - 1]["plan_duration_s"]);
    }
  }
  EXPECT_EQ(Run("verify out").code, 0);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "out/plan.html"));
}

TEST_F(PlanAnytimeProgram, CannotBeCombinedWithWatch) {
  EXPECT_NE(ExpectRefused("plan " + kScenario + " --anytime --watch").find("--anytime"),
            std::string::npos);
}

}  // namespace
}  // namespace possibility::experiments
