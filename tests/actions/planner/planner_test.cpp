#include "actions/planner/planner.h"

#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <set>

#include "actions/plan/plan_rounding.h"
#include "actions/plan/plan_writer.h"
#include "actions/route/route_motion.h"
#include "actions/verify/verification_report.h"
#include "models/input/input_error.h"
#include "tests/actions/drchubo1.h"

namespace possibility::actions {
namespace {

PlanRequest Request(std::uint64_t seed, const std::vector<std::string>& actions) {
  PlanRequest request;
  request.library = DrcHubo1Library();
  request.seed = seed;
  request.actions = actions;
  request.time_limit = 1000;  // sanitizers are slow, and no test is about speed
  return request;
}

void ExpectVerifiedPlans(const std::string& name, const std::vector<std::string>& actions,
                         std::uint64_t seeds, PlannerPreset preset = PlannerPreset::kDefault) {
  const models::Scenario scenario = ShippedScenario(name);
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    PlanRequest request = Request(seed, actions);
    request.preset = preset;
    const PlanResult result = PlanTraversal(DrcHubo1(), scenario, request);
    ASSERT_EQ(result.status, PlanStatus::kFound) << "seed " << seed << ": " << result.explanation;
    ASSERT_TRUE(result.verification.accepted()) << FormatText(result.verification);
    EXPECT_FALSE(result.plan.segments.empty());
    EXPECT_EQ(result.plan.statistics.count("routes refuted by verification"), 0u);
  }
}

TEST(PlannerTest, WalksWhereAWalkingRouteExists) {
  ExpectVerifiedPlans("three_routes_a", {"walk"}, 1);
}

TEST(PlannerTest, VerifiesTheMotionThatItsFileHolds) {
  Plan plan =
      PlanTraversal(DrcHubo1(), ShippedScenario("three_routes_a"), Request(1, {"walk"})).plan;
  const Plan verified = plan;
  RoundToPlanDigits(&plan);
  ASSERT_FALSE(plan.segments.empty());
  for (std::size_t s = 0; s < plan.segments.size(); ++s) {
    for (std::size_t p = 0; p < plan.segments[s].phases.size(); ++p) {
      const std::vector<Knot>& knots = plan.segments[s].phases[p].knots;
      for (std::size_t k = 0; k < knots.size(); ++k) {
        EXPECT_EQ(verified.segments[s].phases[p].knots[k].tau, knots[k].tau);
        EXPECT_EQ(verified.segments[s].phases[p].knots[k].q, knots[k].q);
      }
    }
  }
}

TEST(PlannerTest, CrawlsUnderTheBars) {
  ExpectVerifiedPlans("three_routes_b", {"walk", "crawl"}, 1);
}

TEST(PlannerTest, WalkingAloneUnderTheBarsIsExhausted) {
  const PlanResult result =
      PlanTraversal(DrcHubo1(), ShippedScenario("three_routes_b"), Request(1, {"walk"}));
  EXPECT_EQ(result.status, PlanStatus::kExhausted) << result.explanation;
  EXPECT_NE(result.explanation.find("bar"), std::string::npos) << result.explanation;
  EXPECT_TRUE(result.plan.segments.empty());
}

TEST(PlannerTest, ASolidWallIsProvenInfeasible) {
  const PlanResult result =
      PlanTraversal(DrcHubo1(), ShippedScenario("closed_room"), Request(1, {}));
  EXPECT_EQ(result.status, PlanStatus::kProvenInfeasible) << result.explanation;
  EXPECT_NE(result.explanation.find("dividing_wall"), std::string::npos) << result.explanation;
}

/// The barrier is where the wall stands. The regions that the gaits reached end before it.
TEST(PlannerTest, ANoHoldsItsBarrierAndTheReachedRegions) {
  const models::Scenario scenario = ShippedScenario("closed_room");
  PlanResult result = PlanTraversal(DrcHubo1(), scenario, Request(1, {}));
  ASSERT_TRUE(result.plan.no.has_value());
  EXPECT_EQ(result.plan.no->status, "proven_infeasible");
  EXPECT_EQ(result.plan.no->explanation, result.explanation);
  ASSERT_TRUE(result.plan.no->barrier.has_value());
  const Barrier& barrier = *result.plan.no->barrier;
  EXPECT_EQ(barrier.closed_by, std::vector<std::string>{"dividing_wall"});
  EXPECT_NEAR(barrier.closest.x(), 4.9, 0.1);
  std::set<std::string> actions;
  for (const ReachedRegion& region : barrier.reached) {
    actions.insert(region.action);
    EXPECT_FALSE(region.outlines.empty());
    for (const auto& outline : region.outlines) {
      for (const Eigen::Vector2d& corner : outline) EXPECT_LT(corner.x(), 5) << region.action;
    }
  }
  EXPECT_EQ(actions, (std::set<std::string>{"", "crawl", "walk"}));
  result = PlanTraversal(DrcHubo1(), ShippedScenario("three_routes_b"), Request(1, {"walk"}));
  ASSERT_TRUE(result.plan.no && result.plan.no->barrier);
  ASSERT_EQ(result.plan.no->barrier->reached.size(), 1u);
  EXPECT_EQ(result.plan.no->barrier->reached[0].action, "walk");
}

/// A wall 4 m long in the middle of a wide floor. The argument is the width of the bounds, m.
models::Scenario WallScene(double width) {
  models::Scenario scenario;
  scenario.name = scenario.file = "wall.yaml";
  scenario.robot_file = DrcHubo1().file;
  scenario.actions = {"walk"};
  scenario.start = {"walk", -1, 0, 0, 0};
  scenario.goals = {{"walk", 1, 0, 0, 0}};
  scenario.environment.bounds =
      Eigen::AlignedBox2d(Eigen::Vector2d(-2.5, -width / 2), Eigen::Vector2d(2.5, width / 2));
  models::Obstacle floor;
  floor.name = "floor";
  floor.shape = models::Shape::Box({8, 8, 0.5});
  floor.X_WO.translation().z() = -0.25;
  floor.is_ground = true;
  models::Obstacle wall;
  wall.name = "wall";
  wall.shape = models::Shape::Box({0.2, 4, 2});
  wall.X_WO.translation().z() = 1;
  scenario.environment.obstacles = {floor, wall};
  return scenario;
}

TEST(PlannerTest, AWallThatSpansTheBoundsIsProvenInfeasible) {
  EXPECT_EQ(PlanTraversal(DrcHubo1(), WallScene(7), Request(1, {})).status, PlanStatus::kFound);
  const PlanResult result = PlanTraversal(DrcHubo1(), WallScene(4), Request(1, {}));
  EXPECT_EQ(result.status, PlanStatus::kProvenInfeasible) << result.explanation;
}

/// In whatever stage the limit ends planning, there is an explanation and never an unverified
/// segment.
TEST(PlannerTest, ATimeLimitInAnyStageLeavesNoUnverifiedPlan) {
  const models::Scenario scenario = ShippedScenario("three_routes_b");
  for (const double time_limit : {0.0, 0.1, 0.3, 0.5, 0.7, 0.9}) {
    PlanRequest request = Request(1, {});
    request.time_limit = time_limit;
    const PlanResult result = PlanTraversal(DrcHubo1(), scenario, request);
    if (result.status == PlanStatus::kFound) {
      EXPECT_TRUE(result.verification.accepted());
      EXPECT_FALSE(result.plan.no.has_value());
      continue;
    }
    EXPECT_EQ(result.status, PlanStatus::kTimeLimit);
    ASSERT_TRUE(result.plan.no.has_value());
    EXPECT_EQ(result.plan.no->status, "time_limit");
    EXPECT_EQ(result.plan.scenario_file, scenario.file) << "a page of it can be made";
    EXPECT_TRUE(result.plan.segments.empty());
    EXPECT_FALSE(result.explanation.empty());
  }
}

TEST(PlannerTest, AStartThatIsTheGoalGivesAStandingPlan) {
  models::Scenario scenario = ShippedScenario("three_routes_a");
  scenario.goals = {scenario.start};
  const PlanResult result = PlanTraversal(DrcHubo1(), scenario, Request(1, {"walk"}));
  EXPECT_EQ(result.status, PlanStatus::kFound);
  EXPECT_TRUE(result.verification.accepted()) << FormatText(result.verification);
  EXPECT_LT(result.plan.duration(), 1);
}

std::string BytesOf(PlanResult result, const std::filesystem::path& file) {
  result.plan.timings = {};
  WritePlan(result.plan, file);
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(PlannerTest, OneSeedAndOneThreadGiveTheSameBytes) {
  const models::Scenario scenario = ShippedScenario("three_routes_b");
  const std::filesystem::path file =
      std::filesystem::path(::testing::TempDir()) / "possibility_same_bytes.json";
  const PlanRequest request = Request(3, {"walk", "crawl"});
  const std::string first = BytesOf(PlanTraversal(DrcHubo1(), scenario, request), file);
  const std::string second = BytesOf(PlanTraversal(DrcHubo1(), scenario, request), file);
  std::filesystem::remove(file);
  EXPECT_GT(first.size(), 100000u);
  EXPECT_TRUE(first == second);
}

TEST(PlannerTest, TheMotionOfARouteDoesNotDependOnTheNumberOfThreads) {
  const LocomotionModel& model = DrcHubo1Locomotion();
  Route route;
  for (int i = 0; i < 5; ++i) {
    RouteLeg leg;
    if (i > 0) leg.from = route.back().to;
    leg.to = leg.from * PlanarPose{0.1, 0.02 * i, 0.05};
    route.push_back(leg);
  }
  const std::vector<Segment> one = GenerateMotion(model, {}, route, 1, {});
  const std::vector<Segment> three = GenerateMotion(model, {}, route, 3, {});
  ASSERT_EQ(one.size(), three.size());
  for (size_t s = 0; s < one.size(); ++s) {
    ASSERT_EQ(one[s].phases.size(), three[s].phases.size());
    for (size_t p = 0; p < one[s].phases.size(); ++p) {
      ASSERT_EQ(one[s].phases[p].knots.size(), three[s].phases[p].knots.size());
      for (size_t k = 0; k < one[s].phases[p].knots.size(); ++k) {
        EXPECT_EQ(one[s].phases[p].knots[k].q, three[s].phases[p].knots[k].q);
        EXPECT_EQ(one[s].phases[p].knots[k].forces, three[s].phases[p].knots[k].forces);
      }
    }
  }
}

std::string MessageOf(const models::Scenario& scenario, const PlanRequest& request) {
  try {
    PlanTraversal(DrcHubo1(), scenario, request);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(PlannerTest, BadStancesAndActionsAreNamed) {
  const models::Scenario good = ShippedScenario("three_routes_a");
  models::Scenario scenario = good;
  scenario.start.x = 5;
  scenario.start.y = 1.4;
  EXPECT_NE(MessageOf(scenario, Request(1, {})).find("start: the walk stance"), std::string::npos);
  EXPECT_NE(MessageOf(scenario, Request(1, {})).find("upper_block"), std::string::npos);
  scenario = good;
  scenario.goals[0].z = 0.3;
  EXPECT_NE(MessageOf(scenario, Request(1, {})).find("goals[0]: the walk stance"),
            std::string::npos);
  EXPECT_NE(MessageOf(scenario, Request(1, {})).find("off the ground"), std::string::npos);
  scenario = good;
  scenario.start.x = -20;
  EXPECT_NE(MessageOf(scenario, Request(1, {})).find("outside environment.bounds"),
            std::string::npos);
  EXPECT_NE(MessageOf(good, Request(1, {"wlak"})).find("walk"), std::string::npos);
  EXPECT_NE(MessageOf(good, Request(1, {"crawl"})).find("start.action"), std::string::npos);
}

// Random exploration, as in the paper. With lattices, all seeds give the same plan.
TEST(PlannerLong, ThreeRoutesAIsPlannedByWalkingForFiftySeeds) {
  ExpectVerifiedPlans("three_routes_a", {"walk"}, 50, PlannerPreset::kPaper);
}
TEST(PlannerLong, ThreeRoutesAIsPlannedByWalkingAndCrawlingForFiftySeeds) {
  ExpectVerifiedPlans("three_routes_a", {"walk", "crawl"}, 50, PlannerPreset::kPaper);
}
TEST(PlannerLong, ThreeRoutesBIsPlannedByWalkingAndCrawlingForFiftySeeds) {
  ExpectVerifiedPlans("three_routes_b", {"walk", "crawl"}, 50, PlannerPreset::kPaper);
}

TEST(PlannerLong, OneSeedAndOneThreadGiveTheSameBytesWithJumps) {
  const models::Scenario scenario = ShippedScenario("three_routes_c");
  const std::filesystem::path file =
      std::filesystem::path(::testing::TempDir()) / "possibility_same_bytes_jump.json";
  for (const PlannerPreset preset : {PlannerPreset::kDefault, PlannerPreset::kPaper}) {
    PlanRequest request = Request(3, {"walk", "crawl", "jump"});
    request.preset = preset;
    const std::string first = BytesOf(PlanTraversal(DrcHubo1(), scenario, request), file);
    const std::string second = BytesOf(PlanTraversal(DrcHubo1(), scenario, request), file);
    EXPECT_TRUE(first == second);
  }
  std::filesystem::remove(file);
}

/// From preparation to verification, in one thread and in three.
TEST(PlannerCancellation, WhereverItComesTheRequestThrows) {
  const models::Scenario scenario = ShippedScenario("crack");
  std::int64_t asked = 0;
  const auto plan = [&](int threads, std::int64_t last) {
    std::atomic<std::int64_t> questions = 0;
    PlanRequest request = Request(1, {"walk"});
    request.threads = threads;
    request.cancellation = CancellationToken([&questions, last] { return ++questions <= last; });
    const PlanStatus status = PlanTraversal(DrcHubo1(), scenario, request).status;
    asked = questions;
    return status;
  };
  ASSERT_EQ(plan(1, std::numeric_limits<std::int64_t>::max()), PlanStatus::kFound);
  const std::int64_t all = asked;
  ASSERT_GT(all, 100);
  for (const int threads : {1, 3}) {
    for (const double share : {0.0, 0.1, 0.3, 0.5, 0.7}) {
      const auto last = static_cast<std::int64_t>(share * static_cast<double>(all));
      EXPECT_THROW(plan(threads, last), Cancelled) << threads << " threads, " << share;
    }
  }
}

}  // namespace
}  // namespace possibility::actions
