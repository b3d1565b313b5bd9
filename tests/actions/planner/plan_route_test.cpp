// The route of a plan, in any scene: a path of the explored graph, no slower than the first route
// found, without a vertex passed twice or two transitions in a row.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <random>
#include <set>
#include <string>
#include <tuple>

#include "actions/planner/planner.h"
#include "models/input/input_error.h"
#include "tests/actions/drchubo1.h"
#include "tests/actions/random_scene.h"

namespace possibility::actions {
namespace {

PlanResult PlanFor(const models::Scenario& scenario) {
  PlanRequest request;
  request.seed = 2;
  request.time_limit = 1000;  // sanitizers are slow, and no test is about speed
  request.library = DrcHubo1Library();
  return PlanTraversal(DrcHubo1(), scenario, request);
}

bool IsTransition(const Segment& segment) { return segment.action.find("->") != std::string::npos; }

/// A motion that flows passes a stance within 0.15 m. A rounded bend is the mean of the way up to 1
/// m before and after: where the way turns back, that is 0.5 m from the vertex.
constexpr double kPasses = 0.15 + 0.5;

/// Consecutive segments meet at a vertex. Each segment is an edge of the graph with its action.
void ExpectAPathOfTheGraph(const Plan& plan) {
  std::set<std::tuple<int, int, std::string>> edges;
  for (const ExploredGraph::Edge& edge : plan.explored.edges) {
    edges.insert({edge.from, edge.to, edge.action});
  }
  for (size_t i = 0; i < plan.segments.size(); ++i) {
    const Segment& segment = plan.segments[i];
    const auto [from, to] = segment.vertices;
    // A transition belongs to the gait that it leads to. Either gait may own the way back.
    const size_t arrow = segment.action.find("->");
    const bool known = arrow == std::string::npos
                           ? edges.count({from, to, segment.action}) > 0
                           : edges.count({from, to, segment.action.substr(arrow + 2)}) > 0 ||
                                 edges.count({from, to, segment.action.substr(0, arrow)}) > 0;
    EXPECT_TRUE(known) << "segment " << i << ": " << segment.action;
    if (i > 0) {
      EXPECT_EQ(plan.segments[i - 1].vertices[1], from);
    }
    const ExploredGraph::Vertex& start = plan.explored.vertices[from];
    const Eigen::VectorXd& q = segment.phases.front().knots.front().q;
    const bool rests = segment.phases.front().knots.front().v.lpNorm<Eigen::Infinity>() < 1e-6;
    EXPECT_LT((q.segment<3>(4) - start.position).norm(), rests ? 1e-5 : kPasses) << "segment " << i;
  }
}

void ExpectNothingInVain(const Plan& plan) {
  for (size_t i = 1; i < plan.segments.size(); ++i) {
    const Segment& before = plan.segments[i - 1];
    const Segment& segment = plan.segments[i];
    EXPECT_FALSE(IsTransition(before) && IsTransition(segment)) << i;
    EXPECT_NE(before.vertices[0], segment.vertices[1]) << i;
  }
  std::set<int> passed;
  for (const Segment& segment : plan.segments) {
    EXPECT_TRUE(passed.insert(segment.vertices[0]).second) << "a vertex is passed twice";
  }
}

void ExpectGoodRoute(const PlanResult& result) {
  ASSERT_EQ(result.status, PlanStatus::kFound) << result.explanation;
  const Plan& plan = result.plan;
  ExpectAPathOfTheGraph(plan);
  ExpectNothingInVain(plan);
  ASSERT_TRUE(plan.search.has_value());
  EXPECT_LE(plan.search->duration, plan.search->first_duration + 1e-9);
  EXPECT_LE(plan.search->lower_bound, plan.search->duration + 1e-9);
  EXPECT_FALSE(plan.search->explorers.empty());
  // The duration that routes are chosen by is near the duration of the motion, or longer: it does
  // not know how far bends will be rounded.
  EXPECT_GT(plan.search->duration, 0.9 * plan.duration());
  EXPECT_LT(plan.search->duration, 1.2 * plan.duration());
}

class PlanRoute : public ::testing::TestWithParam<const char*> {};

TEST_P(PlanRoute, InAShippedSceneIsAPathOfTheGraphWithoutDetours) {
  ExpectGoodRoute(PlanFor(ShippedScenario(GetParam())));
}

INSTANTIATE_TEST_SUITE_P(Scenes, PlanRoute,
                         ::testing::Values("three_routes_a", "three_routes_b", "three_routes_c",
                                           "hallway", "double_jump"));

/// Random start and goal in a random scene. The robot may be unable to stand there.
models::Scenario RandomScenario(std::mt19937* generator) {
  models::Scenario scenario;
  scenario.name = scenario.file = "random.yaml";
  scenario.robot_file = DrcHubo1().file;
  scenario.actions = {"walk", "crawl"};
  scenario.environment = RandomEnvironment(generator, 8);
  std::vector<models::Obstacle>& obstacles = scenario.environment.obstacles;
  // One floor instead of two with a gap between them.
  obstacles.erase(obstacles.begin() + 1);
  obstacles[0].name = "floor";
  obstacles[0].shape = models::Shape::Box({8, 8, 0.5});
  obstacles[0].X_WO.translation() = Eigen::Vector3d(0, 0, -0.25);
  std::uniform_real_distribution<double> unit(-1, 1);
  scenario.start = {"walk", -2.2, 2 * unit(*generator), 0, 0};
  scenario.goals = {{"walk", 2.2, 2 * unit(*generator), 0, unit(*generator)}};
  return scenario;
}

int GoodRoutes(int scenes) {
  std::mt19937 generator(5);
  int found = 0;
  for (int scene = 0; scene < scenes; ++scene) {
    SCOPED_TRACE(fmt::format("scene {}", scene));
    PlanResult result;
    try {
      result = PlanFor(RandomScenario(&generator));
    } catch (const InputError&) {
      continue;  // the robot cannot stand at an end
    }
    if (result.status != PlanStatus::kFound) continue;
    ++found;
    ExpectGoodRoute(result);
  }
  return found;
}

TEST(PlanRoutes, InRandomScenesArePathsOfTheGraphWithoutDetours) { EXPECT_GT(GoodRoutes(8), 1); }

TEST(PlanRoutesLong, InFiftyRandomScenesArePathsOfTheGraphWithoutDetours) {
  EXPECT_GT(GoodRoutes(50), 15);
}

}  // namespace
}  // namespace possibility::actions
