// What is tested with DRC-HUBO1 alone elsewhere, for every other robot of models/: soundness,
// determinism, and its scenarios.

#include "tests/actions/shipped_robots.h"

#include <gtest/gtest.h>

#include "actions/gait/stride.h"
#include "actions/plan/plan_writer.h"
#include "actions/planner/planner.h"
#include "models/input/file_contents.h"
#include "models/world/scenario.h"
#include "tests/actions/planner/soundness.h"
#include "tests/models/temporary_folder.h"

namespace possibility::actions {
namespace {

class EveryRobot : public ::testing::TestWithParam<std::string> {
 protected:
  static const ShippedRobot& Robot() { return RobotNamed(GetParam()); }

  static std::filesystem::path Folder() {
    return std::filesystem::path(POSSIBILITY_SOURCE_DIR) / "experiments/scenarios" / GetParam();
  }

  static std::vector<std::filesystem::path> Scenarios() {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(Folder())) {
      files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    return files;
  }

  static PlanResult PlanOf(const std::filesystem::path& scenario) {
    PlanRequest request;
    request.library = Robot().Library();
    request.threads = 1;
    request.time_limit = 1000;  // sanitizers are slow, and no test is about speed
    return PlanTraversal(Robot().robot(), models::LoadScenario(scenario), request);
  }
};
using EveryRobotLong = EveryRobot;

TEST_P(EveryRobot, Flows) { EXPECT_TRUE(Robot().model().gaits[0]->motion->Flows()); }

/// Routes are chosen by what their ways are expected to take.
TEST_P(EveryRobot, ExpectedDurationOfFurtherStridesAheadIsThatOfTheMotion) {
  const LocomotionModel::GaitEntry& gait = *Robot().model().gaits[0];
  const models::GaitParameters& parameters = gait.stance.gait->parameters;
  constexpr double kSpacing = 0.1;  // s
  const auto duration = [&](int strides) {
    const PlanarPose end{strides * parameters.forward, 0, 0};
    return gait.motion->Motion(PlanStrides(parameters, {}, end), kSpacing, {})
        .back()
        .knots.back()
        .t;
  };
  const double further = duration(50) - duration(10);  // a way takes whole steps
  EXPECT_NEAR(gait.motion->ExpectedDuration(50) - gait.motion->ExpectedDuration(10), further,
              0.1 * further);
}

TEST_P(EveryRobot, SufficientLegsVerify) {
  ExpectSufficientLegsVerify(Robot().model(), 4, 21, [](auto* g) { return RandomExtension(g, 0); });
}

TEST_P(EveryRobot, RoutesOfSufficientLegsVerify) {
  ExpectSufficientRoutesVerify(Robot().model(), 2, 22, 0);
}

TEST_P(EveryRobot, VerifiedLegsMeetNecessaryConditions) {
  ExpectVerifiedLegsMeetNecessaryConditions(Robot().model(), 3, 23);
}

TEST_P(EveryRobot, OneSeedAndOneThreadGiveTheSameBytes) {
  const models::TemporaryFolder folder;
  std::vector<std::string> bytes;
  for (const char* name : {"first.json", "second.json"}) {
    PlanResult result = PlanOf(Folder() / "flat.yaml");
    ASSERT_EQ(result.status, PlanStatus::kFound) << result.explanation;
    result.plan.timings = {};
    WritePlan(result.plan, folder.path() / name);
    bytes.push_back(models::ReadFileContents(folder.path() / name));
  }
  EXPECT_GT(bytes[0].size(), 100000u);
  EXPECT_TRUE(bytes[0] == bytes[1]);
}

TEST_P(EveryRobot, HasTwoScenariosAndPlansThem) {
  EXPECT_GE(Scenarios().size(), 2u);
  for (const std::filesystem::path& file : Scenarios()) {
    const PlanResult result = PlanOf(file);
    ASSERT_EQ(result.status, PlanStatus::kFound) << file << ": " << result.explanation;
    EXPECT_TRUE(result.verification.accepted()) << file << FormatText(result.verification);
    EXPECT_FALSE(result.plan.segments.empty());
  }
}

TEST_P(EveryRobotLong, HundredSufficientLegsVerify) {
  ExpectSufficientLegsVerify(Robot().model(), 100, 31,
                             [](auto* g) { return RandomExtension(g, 0); });
}
TEST_P(EveryRobotLong, HundredRoutesOfSufficientLegsVerify) {
  ExpectSufficientRoutesVerify(Robot().model(), 100, 32, 0);
}
TEST_P(EveryRobotLong, HundredVerifiedLegsMeetNecessaryConditions) {
  ExpectVerifiedLegsMeetNecessaryConditions(Robot().model(), 100, 33);
}

const auto kNameOfRobot = [](const auto& info) { return info.param; };
INSTANTIATE_TEST_SUITE_P(Models, EveryRobot, ::testing::ValuesIn(ShippedRobotNames()),
                         kNameOfRobot);
INSTANTIATE_TEST_SUITE_P(Models, EveryRobotLong, ::testing::ValuesIn(ShippedRobotNames()),
                         kNameOfRobot);

}  // namespace
}  // namespace possibility::actions
