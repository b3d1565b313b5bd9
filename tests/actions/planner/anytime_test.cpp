// Planning that goes on after the first plan, and the lower bound of durations.
#include <gtest/gtest.h>

#include <filesystem>
#include <random>

#include "actions/planner/planner.h"
#include "actions/verify/verification_report.h"
#include "common/stopwatch.h"
#include "tests/actions/drchubo1.h"

namespace possibility::actions {
namespace {

std::vector<PlanResult> PlansOf(const models::Scenario& scenario, double time_limit,
                                PlanRequest request = {}) {
  std::vector<PlanResult> plans;
  request.library = DrcHubo1Library();
  request.time_limit = time_limit;
  request.improved = [&](const PlanResult& result) { plans.push_back(result); };
  PlanTraversal(DrcHubo1(), scenario, request);
  return plans;
}

void ExpectBounded(const std::vector<PlanResult>& plans, const models::Scenario& scenario) {
  for (std::size_t i = 0; i < plans.size(); ++i) {
    const VerificationReport report = Verify(plans[i].plan, DrcHubo1(), scenario);
    EXPECT_TRUE(report.accepted()) << scenario.name << "\n" << FormatText(report);
    EXPECT_GT(plans[i].least_duration, 0) << scenario.name;
    EXPECT_LE(plans[i].least_duration, plans[i].plan.duration()) << scenario.name;
    if (i > 0) {
      EXPECT_LT(plans[i].plan.duration(), plans[i - 1].plan.duration());
    }
  }
}

TEST(Anytime, EveryPlanIsVerifiedAndQuickerThanTheLastAndNoneBelowTheBound) {
  models::Scenario scenario = ShippedScenario("three_routes_a");
  PlanRequest walking;
  walking.actions = {"walk"};
  const std::vector<PlanResult> plans = PlansOf(scenario, 12, walking);
  ASSERT_FALSE(plans.empty());
  scenario.actions = {"walk"};
  ExpectBounded(plans, scenario);
}

TEST(Anytime, EndsAtTheTimeLimit) {
  const models::Scenario scenario = ShippedScenario("doorway");
  const Stopwatch stopwatch;
  const std::vector<PlanResult> plans = PlansOf(scenario, 6);
  EXPECT_FALSE(plans.empty());
  EXPECT_LT(stopwatch.Seconds(),
            6 + 12);  // or, on a busy machine, when the first plan is verified
}

TEST(AnytimeLong, NoVerifiedPlanOfAShippedSceneIsBelowTheBound) {
  const std::filesystem::path folder =
      std::filesystem::path(POSSIBILITY_SOURCE_DIR) / "experiments/scenarios";
  int scenes = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".yaml") continue;
    const std::string name = entry.path().stem().string();
    if (name == "closed_room" || name.find("infeasible") != std::string::npos) continue;
    const models::Scenario scenario = ShippedScenario(name);
    // The steps over the sill of crawl_sill take longer to find.
    const std::vector<PlanResult> plans = PlansOf(scenario, name == "crawl_sill" ? 60 : 15);
    EXPECT_FALSE(plans.empty()) << name;
    ExpectBounded(plans, scenario);
    ++scenes;
  }
  EXPECT_GE(scenes, 20);
}

/// Boxes at random in the shipped room of the three routes.
TEST(AnytimeLong, NoVerifiedPlanOfARandomSceneIsBelowTheBound) {
  std::mt19937 generator(11);
  std::uniform_real_distribution<double> unit(0, 1);
  int found = 0;
  for (int trial = 0; trial < 20; ++trial) {
    models::Scenario scenario = ShippedScenario("three_routes_a");
    const Eigen::AlignedBox2d& bounds = scenario.environment.bounds;
    for (int i = 0; i < 6; ++i) {
      models::Obstacle box;
      box.name = fmt::format("box {}", i);
      box.shape = models::Shape::Box({0.3, 0.3, 1.5});
      const Eigen::Vector2d place =
          bounds.min() +
          Eigen::Vector2d(unit(generator), unit(generator)).cwiseProduct(bounds.sizes());
      const Eigen::Vector2d start(scenario.start.x, scenario.start.y);
      const Eigen::Vector2d goal(scenario.goals[0].x, scenario.goals[0].y);
      if ((place - start).norm() < 0.8 || (place - goal).norm() < 0.8) continue;
      box.X_WO.translation() << place, 0.75;
      scenario.environment.obstacles.push_back(box);
    }
    scenario.content_hash += fmt::format(" {}", trial);
    const std::vector<PlanResult> plans = PlansOf(scenario, 8);
    ExpectBounded(plans, scenario);
    found += plans.empty() ? 0 : 1;
  }
  EXPECT_GT(found, 10);
}

}  // namespace
}  // namespace possibility::actions
