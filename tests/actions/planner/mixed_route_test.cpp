#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "actions/planner/planner.h"
#include "tests/actions/drchubo1.h"

namespace possibility::actions {
namespace {

PlanResult PlanWith(const std::string& scene, const std::vector<std::string>& actions) {
  PlanRequest request;
  request.library = DrcHubo1Library();
  request.actions = actions;
  return PlanTraversal(DrcHubo1(), ShippedScenario(scene), request);
}

/// Whether a segment of the plan uses the action.
bool IncludesAction(const PlanResult& result, const std::string& action) {
  const std::vector<Segment>& segments = result.plan.segments;
  return std::any_of(segments.begin(), segments.end(),
                     [&](const Segment& segment) { return segment.action == action; });
}

void Add(const std::string& name, const Eigen::Vector3d& size, const Eigen::Vector3d& position,
         bool is_ground, models::Environment* environment) {
  models::Obstacle obstacle;
  obstacle.name = name;
  obstacle.shape = models::Shape::Box(size);
  obstacle.X_WO.translation() = position;
  obstacle.is_ground = is_ground;
  environment->obstacles.push_back(obstacle);
}

/// Two ways lead from the start to the goal's side, each across a crack and under a bar. The first
/// ends on a slab close to the goal, behind a gap that nothing crosses.
///
///  y  1 +--------bar------+ +-----+       +-------+
///       | S               | | end |  gap  |   G   |
///    -1 +-----+-----wall--+ +-----+-------+       |
///  -1.1 +-----+-------------bar-----------+       |
///       |                                         |
///  -3.1 +-----------------------------------------+
///      -2    0.5          4 4.1   5      6.2      8  x
models::Scenario ASlabThatLeadsNowhere() {
  models::Scenario scenario = ShippedScenario("sill");
  scenario.actions = {"walk", "crawl"};
  models::Environment& environment = scenario.environment;
  const auto box = [](double x0, double x1, double y0, double y1, double z0, double z1) {
    return Eigen::AlignedBox3d(Eigen::Vector3d(x0, y0, z0), Eigen::Vector3d(x1, y1, z1));
  };
  const auto add = [&](const std::string& name, const Eigen::AlignedBox3d& place, bool is_ground) {
    Add(name, place.sizes(), place.center(), is_ground, &environment);
  };
  environment.obstacles.clear();
  environment.bounds = {Eigen::Vector2d(-2, -3.1), Eigen::Vector2d(8, 1)};
  add("start", box(-2, 4, -1, 1, -0.5, 0), true);
  add("end", box(4.1, 5, -1, 1, -0.5, 0), true);
  add("way round", box(-2, 8, -3.1, -1.1, -0.5, 0), true);
  add("goal", box(6.2, 8, -1.1, 1, -0.5, 0), true);
  add("wall", box(0.5, 6.2, -1.1, -1, -0.5, 2), false);
  add("first bar", box(1.5, 1.6, -1, 1, 1.1, 2), false);
  add("second bar", box(3, 3.1, -3.1, -1.1, 1.1, 2), false);
  scenario.start.x = -0.5;
  scenario.start.y = 0;
  scenario.goals[0].x = 7;
  scenario.goals[0].y = 0;
  return scenario;
}

TEST(MixedRoute, AnIslandThatLeadsNowhereIsLeftAgain) {
  PlanRequest request;
  request.library = DrcHubo1Library();
  const PlanResult result = PlanTraversal(DrcHubo1(), ASlabThatLeadsNowhere(), request);
  ASSERT_EQ(result.status, PlanStatus::kFound) << result.explanation;
  EXPECT_TRUE(result.verification.accepted());
  EXPECT_TRUE(IncludesAction(result, "crawl"));
}

// With manoeuvres among the actions the floods cannot tell whether a route exists.
TEST(MixedRoute, StepsAreAlsoPlannedBesideManoeuvres) {
  const PlanResult result = PlanWith("stairs", {"walk", "crawl", "jump"});
  ASSERT_EQ(result.status, PlanStatus::kFound) << result.explanation;
  EXPECT_TRUE(result.verification.accepted());
  const auto& explorers = result.plan.search->explorers;
  EXPECT_NE(std::find(explorers.begin(), explorers.end(), "footsteps"), explorers.end());
}

/// A sill before a bar so low that only crawling leads under it, and another sill behind.
models::Scenario SillsAndABar() {
  models::Scenario scenario = ShippedScenario("sill");
  scenario.actions = {"walk", "crawl"};
  models::Environment& environment = scenario.environment;
  environment.obstacles.clear();
  environment.bounds = {Eigen::Vector2d(-2.5, -1), Eigen::Vector2d(7.5, 1)};
  Add("floor", {11, 3, 0.5}, {2.5, 0, -0.25}, true, &environment);
  Add("first sill", {0.06, 3, 0.08}, {-0.5, 0, 0.04}, false, &environment);
  Add("bar", {0.1, 3, 1}, {2.4, 0, 1.6}, false, &environment);
  Add("second sill", {0.06, 3, 0.08}, {5.4, 0, 0.04}, false, &environment);
  scenario.start.x = -1.5;
  scenario.start.y = 0;
  scenario.goals[0].x = 6.5;
  scenario.goals[0].y = 0;
  return scenario;
}

TEST(MixedRoute, StepsAndGaitsAreJoined) {
  PlanRequest request;
  request.library = DrcHubo1Library();
  const PlanResult result = PlanTraversal(DrcHubo1(), SillsAndABar(), request);
  ASSERT_EQ(result.status, PlanStatus::kFound) << result.explanation;
  EXPECT_TRUE(result.verification.accepted());
  EXPECT_TRUE(IncludesAction(result, "crawl"));
  EXPECT_TRUE(IncludesAction(result, "walk"));
}

TEST(MixedRouteLong, ACourseOfEverythingIsPlanned) {
  PlanRequest request;
  request.library = DrcHubo1Library();
  const PlanResult result = PlanTraversal(DrcHubo1(), ShippedScenario("everything"), request);
  ASSERT_EQ(result.status, PlanStatus::kFound) << result.explanation;
  EXPECT_TRUE(result.verification.accepted());
  for (const char* action : {"walk", "crawl", "leap"})
    EXPECT_TRUE(IncludesAction(result, action)) << action;
}

TEST(MixedRoute, WithoutAWayUnderTheBarThereIsNone) {
  models::Scenario scenario = SillsAndABar();
  scenario.environment.obstacles[2].shape = models::Shape::Box({0.1, 3, 1.8});
  scenario.environment.obstacles[2].X_WO.translation().z() = 1.2;
  PlanRequest request;
  request.library = DrcHubo1Library();
  const PlanResult result = PlanTraversal(DrcHubo1(), scenario, request);
  EXPECT_TRUE(result.status == PlanStatus::kExhausted ||
              result.status == PlanStatus::kProvenInfeasible)
      << result.explanation;
}

}  // namespace
}  // namespace possibility::actions
