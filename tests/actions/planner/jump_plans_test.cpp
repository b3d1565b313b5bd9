#include <gtest/gtest.h>

#include <algorithm>

#include "actions/planner/planner.h"
#include "actions/verify/verification_report.h"
#include "tests/actions/drchubo1.h"

namespace possibility::actions {
namespace {

PlanRequest JumpRequest(std::uint64_t seed, int threads) {
  PlanRequest request;
  request.seed = seed;
  request.threads = threads;
  request.actions = {"walk", "crawl", "jump"};
  request.time_limit = 1000;  // sanitizers are slow, and no test is about speed
  request.library = DrcHubo1Library();
  return request;
}

bool Jumps(const Plan& plan) {
  return std::any_of(plan.segments.begin(), plan.segments.end(),
                     [](const Segment& segment) { return segment.action == "jump"; });
}

void ExpectVerifiedPlans(const std::string& name, std::uint64_t seeds, bool jump_needed,
                         int threads = 1, PlannerPreset preset = PlannerPreset::kDefault) {
  const models::Scenario scenario = ShippedScenario(name);
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    PlanRequest request = JumpRequest(seed, threads);
    request.preset = preset;
    const PlanResult result = PlanTraversal(DrcHubo1(), scenario, request);
    ASSERT_EQ(result.status, PlanStatus::kFound) << "seed " << seed << ": " << result.explanation;
    ASSERT_TRUE(result.verification.accepted())
        << "seed " << seed << ": " << FormatText(result.verification);
    EXPECT_TRUE(Jumps(result.plan) || !jump_needed) << "seed " << seed;
  }
}

void ExpectRandomPlans(const std::string& name, bool jump_needed) {
  ExpectVerifiedPlans(name, 50, jump_needed, 1, PlannerPreset::kPaper);
}

/// Expects a "no" (not a time limit) and no segment of a plan.
void ExpectNo(const std::string& name, std::uint64_t runs) {
  const models::Scenario scenario = ShippedScenario(name);
  for (std::uint64_t seed = 1; seed <= runs; ++seed) {
    const PlanResult result = PlanTraversal(DrcHubo1(), scenario, JumpRequest(seed, 1));
    EXPECT_TRUE(result.status == PlanStatus::kExhausted ||
                result.status == PlanStatus::kProvenInfeasible)
        << "seed " << seed << ": " << result.explanation;
    EXPECT_TRUE(result.plan.segments.empty());
  }
}

TEST(JumpPlans, TheGapOfTheHallwayIsJumped) { ExpectVerifiedPlans("hallway", 1, true); }

/// The hallway's gap is 0.45 m wide. Behind the bars the robot stands up and leaps.
TEST(JumpPlans, AWiderGapOfTheHallwayIsLeaptOnFeet) {
  models::Scenario scenario = ShippedScenario("hallway");
  for (models::Obstacle& obstacle : scenario.environment.obstacles) {
    if (obstacle.name != "left_floor") continue;
    obstacle.shape.size.x() -= 0.15;
    obstacle.X_WO.translation().x() -= 0.075;
  }
  PlanRequest request = JumpRequest(1, 1);
  request.actions = {"walk", "crawl", "leap"};
  const PlanResult result = PlanTraversal(DrcHubo1(), scenario, request);
  ASSERT_EQ(result.status, PlanStatus::kFound) << result.explanation;
  EXPECT_TRUE(result.verification.accepted()) << FormatText(result.verification);
  EXPECT_EQ(std::count_if(result.plan.segments.begin(), result.plan.segments.end(),
                          [](const Segment& segment) { return segment.action == "leap"; }),
            1);
}

TEST(JumpPlans, BarsTooLowToCrawlAndTooManyToJumpAreRefused) { ExpectNo("hallway_infeasible", 1); }
TEST(JumpPlans, AGapBeyondReachIsRefused) { ExpectNo("three_routes_c_infeasible", 1); }
TEST(JumpPlans, ABlockedLandingIsRefused) { ExpectNo("double_jump_infeasible", 1); }

TEST(JumpPlansLong, EverySceneIsCrossed) {
  ExpectVerifiedPlans("three_routes_a", 1, false);
  ExpectVerifiedPlans("three_routes_b", 1, false);
  ExpectVerifiedPlans("three_routes_c", 1, true);
  ExpectVerifiedPlans("double_jump", 1, true);
}
TEST(JumpPlansLong, FourThreadsPlanTheHallway) { ExpectVerifiedPlans("hallway", 10, true, 4); }

// Random exploration, as in the paper. With lattices, all seeds give the same plan.
TEST(JumpPlansLong, ThreeRoutesAIsPlannedForFiftySeeds) {
  ExpectRandomPlans("three_routes_a", false);
}
TEST(JumpPlansLong, ThreeRoutesBIsPlannedForFiftySeeds) {
  ExpectRandomPlans("three_routes_b", false);
}
TEST(JumpPlansLong, ThreeRoutesCIsJumpedForFiftySeeds) {
  ExpectRandomPlans("three_routes_c", true);
}
TEST(JumpPlansLong, TheHallwayIsJumpedForFiftySeeds) { ExpectRandomPlans("hallway", true); }
TEST(JumpPlansLong, TheDoubleJumpIsJumpedForFiftySeeds) { ExpectRandomPlans("double_jump", true); }

TEST(JumpPlansLong, InfeasibleScenesAreRefusedForTwentySeeds) {
  for (const char* name :
       {"hallway_infeasible", "three_routes_c_infeasible", "double_jump_infeasible"}) {
    ExpectNo(name, 20);
  }
}

}  // namespace
}  // namespace possibility::actions
