// Scenes that lattices alone hardly cross, if at all. The random exploration of the paper crosses
// each of them, and so does the planner, which has both, with any seed.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "actions/planner/planner.h"
#include "actions/verify/verification_report.h"
#include "tests/actions/drchubo1.h"

namespace possibility::actions {
namespace {

PlanResult PlanFor(const std::string& scene, std::uint64_t seed,
                   const std::vector<std::string>& explorers, PlannerPreset preset) {
  PlanRequest request;
  request.seed = seed;
  request.time_limit = 1000;  // sanitizers are slow, and no test is about speed
  request.explorers = explorers;
  request.preset = preset;
  request.library = DrcHubo1Library();
  return PlanTraversal(DrcHubo1(), ShippedScenario(scene), request);
}

void ExpectPlans(const std::string& scene, std::uint64_t seeds, PlannerPreset preset) {
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const PlanResult result = PlanFor(scene, seed, {}, preset);
    ASSERT_EQ(result.status, PlanStatus::kFound) << "seed " << seed << ": " << result.explanation;
    EXPECT_TRUE(result.verification.accepted()) << FormatText(result.verification);
  }
}

class ExplorerScenes : public ::testing::TestWithParam<const char*> {};

class BeyondLattices : public ExplorerScenes {};

TEST_P(BeyondLattices, LatticesAloneFindNothing) {
  const PlanResult result =
      PlanFor(GetParam(), 1, {"straight", "lattice", "shortcuts"}, PlannerPreset::kDefault);
  EXPECT_EQ(result.status, PlanStatus::kTimeLimit) << result.explanation;
  EXPECT_TRUE(result.plan.segments.empty());
}

TEST_P(ExplorerScenes, RandomExplorationFindsAWay) {
  const PlanResult result = PlanFor(GetParam(), 1, {"random"}, PlannerPreset::kDefault);
  ASSERT_EQ(result.status, PlanStatus::kFound) << result.explanation;
  EXPECT_EQ(result.plan.search->explorers, std::vector<std::string>{"random"});
}

TEST_P(ExplorerScenes, AllExplorersTogetherFindAWay) {
  ExpectPlans(GetParam(), 1, PlannerPreset::kDefault);
}

class ExplorerScenesLong : public ::testing::TestWithParam<const char*> {};

TEST_P(ExplorerScenesLong, AreCrossedWithFiftySeedsByDefault) {
  ExpectPlans(GetParam(), 50, PlannerPreset::kDefault);
}

TEST_P(ExplorerScenesLong, AreCrossedWithFiftySeedsByThePapersExploration) {
  ExpectPlans(GetParam(), 50, PlannerPreset::kPaper);
}

constexpr const char* kScenes[] = {"bug_trap", "oblique_jump", "oblique_tunnel"};
INSTANTIATE_TEST_SUITE_P(Scenes, ExplorerScenes, ::testing::ValuesIn(kScenes));
INSTANTIATE_TEST_SUITE_P(Scenes, BeyondLattices, ::testing::Values("bug_trap", "oblique_tunnel"));
INSTANTIATE_TEST_SUITE_P(Scenes, ExplorerScenesLong, ::testing::ValuesIn(kScenes));

}  // namespace
}  // namespace possibility::actions
