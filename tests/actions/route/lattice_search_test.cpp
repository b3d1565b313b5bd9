#include "actions/route/lattice_search.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "actions/conditions/exploration_pose.h"
#include "actions/jump/long_jump.h"
#include "models/world/ground_map.h"
#include "tests/actions/drchubo1.h"
#include "tests/actions/lattice_proposal.h"

namespace possibility::actions {
namespace {

/// The robot with its actions in a shipped scenario.
class Scene {
 public:
  Scene(const std::string& name, bool with_jumps)
      : scenario_(ShippedScenario(name)),
        ground_(scenario_.environment),
        world_{&scenario_.environment, &ground_},
        space_(std::make_shared<PelvisPoseSpace>(scenario_.environment.bounds, ground_.levels(),
                                                 scenario_.planner.rotation_weight)) {
    const LocomotionModel& model = DrcHubo1Locomotion();
    for (int gait = 0; gait < static_cast<int>(model.gaits.size()); ++gait) {
      gaits_.push_back(
          std::make_shared<QuasiStaticAction>(model, gait, world_, space_, scenario_.planner.step));
    }
    if (with_jumps) AddJumps();
  }

  std::vector<graph::PathEdge> Search(const LatticeSettings& settings) const {
    LatticeSearch search(space(), Grounded(scenario_.start), goals(), settings);
    LatticeSearch::Status status = LatticeSearch::Status::kSearching;
    while (status == LatticeSearch::Status::kSearching) status = search.Advance(100, {});
    if (status == LatticeSearch::Status::kGivenUp) return {};
    return search.Route();
  }

  /// The first proposal of a LatticeExplorer.
  std::vector<graph::PathEdge> Proposal() const {
    return FirstProposal(space(), Grounded(scenario_.start), goals());
  }

  RouteSpace space() const { return {&DrcHubo1Locomotion(), &gaits_, &manoeuvres_}; }

  void Block(const graph::PathEdge& edge) {
    const int gaits = static_cast<int>(gaits_.size());
    if (edge.action >= gaits) {
      manoeuvres_[edge.action - gaits]->Forbid(edge.points, "for a test", false);
    } else {
      gaits_[edge.action]->Forbid(edge.points);
    }
  }

  graph::Point PointOf(const models::Stance& stance) const {
    const GroundedStance grounded = Grounded(stance);
    return ToPoint(
        DrcHubo1Locomotion().gaits[grounded.gait]->stance.RootPose(grounded.pose, grounded.z));
  }

  bool Holds(const graph::PathEdge& edge) const {
    const int gaits = static_cast<int>(gaits_.size());
    if (edge.action < gaits) return gaits_[edge.action]->CS(edge.points);
    return manoeuvres_[edge.action - gaits]->Explorable(edge.points);
  }

  const models::Scenario& scenario() const { return scenario_; }
  GroundedStance start() const { return Grounded(scenario_.start); }
  std::vector<GroundedStance> goals() const {
    std::vector<GroundedStance> goals;
    for (const models::Stance& goal : scenario_.goals) goals.push_back(Grounded(goal));
    return goals;
  }
  int num_gaits() const { return static_cast<int>(gaits_.size()); }

 private:
  static GroundedStance Grounded(const models::Stance& stance) {
    return {
        DrcHubo1Locomotion().GaitIndex(stance.action), {stance.x, stance.y, stance.yaw}, stance.z};
  }

  void AddJumps() {
    PlanningContext context;
    context.model = &DrcHubo1Locomotion();
    context.world = world_;
    context.gaits.assign(gaits_.begin(), gaits_.end());
    context.space = space_;
    context.library = DrcHubo1Library();
    for (const auto& jump :
         MakeManoeuvres(JumpFactories(DrcHubo1()), scenario_.actions, context, "test")) {
      manoeuvres_.push_back(std::make_shared<SearchedManoeuvre>(jump));
    }
  }

  models::Scenario scenario_;
  models::GroundMap ground_;
  World world_;
  std::shared_ptr<PelvisPoseSpace> space_;
  std::vector<std::shared_ptr<QuasiStaticAction>> gaits_;
  std::vector<std::shared_ptr<SearchedManoeuvre>> manoeuvres_;
};

constexpr LatticeSettings kFast = {.step = 0.2, .headings = 8, .greed = 4};

void ExpectRoute(const Scene& scene, const std::vector<graph::PathEdge>& route) {
  ASSERT_FALSE(route.empty());
  EXPECT_EQ(route.front().points.from, scene.PointOf(scene.scenario().start));
  EXPECT_EQ(route.back().points.to, scene.PointOf(scene.scenario().goals[0]));
  for (std::size_t i = 0; i < route.size(); ++i) {
    EXPECT_TRUE(scene.Holds(route[i])) << i;
    const graph::Point& before = i == 0 ? route.front().points.from : route[i - 1].points.to;
    EXPECT_EQ(route[i].points.from, before);
  }
}

TEST(LatticeSearch, FindsRoutesOnWhichEveryConditionHolds) {
  for (const char* name : {"three_routes_a", "three_routes_b"}) {
    const Scene scene(name, false);
    ExpectRoute(scene, scene.Search(kFast));
    ExpectRoute(scene, scene.Search({.step = 0.3, .headings = 12, .greed = 1}));
  }
}

TEST(LatticeSearch, JumpsWhereNothingElseLeads) {
  for (const char* name : {"three_routes_c", "hallway", "double_jump"}) {
    const Scene scene(name, true);
    const std::vector<graph::PathEdge> route = scene.Search(kFast);
    ExpectRoute(scene, route);
    int jumps = 0;
    for (const graph::PathEdge& edge : route) jumps += edge.action >= scene.num_gaits() ? 1 : 0;
    // Greed may take a jump where sitting down would do.
    EXPECT_GE(jumps, std::string(name) == "double_jump" ? 2 : 1) << name;
    EXPECT_TRUE(Scene(name, false).Search(kFast).empty()) << name;
  }
}

TEST(LatticeSearch, ShortStridesLeadToWhereManoeuvresBegin) {
  for (const char* name : {"three_routes_c", "hallway", "double_jump"}) {
    for (const double step : {0.4, 0.6, 0.8, 1.0}) {
      const Scene scene(name, true);
      SCOPED_TRACE(fmt::format("{}, step {}", name, step));
      ExpectRoute(scene, scene.Search({.step = step, .headings = 1, .greed = 3}));
    }
  }
}

TEST(LatticeSearch, ConsecutiveStraightStridesAreOneEdge) {
  const Scene scene("double_jump", true);
  const std::vector<graph::PathEdge> route = scene.Search(kFast);
  ASSERT_FALSE(route.empty());
  for (std::size_t i = 1; i < route.size(); ++i) {
    if (route[i].action != 0 || route[i - 1].action != 0) continue;
    const graph::Point before = route[i - 1].points.to - route[i - 1].points.from;
    const graph::Point after = route[i].points.to - route[i].points.from;
    if (before.tail<5>().norm() > 1e-9 || after.tail<5>().norm() > 1e-9) continue;
    EXPECT_LT(before.head<2>().normalized().dot(after.head<2>().normalized()), 1 - 1e-9) << i;
  }
}

TEST(LatticeSearch, AvoidsForbiddenEdges) {
  for (const char* name : {"three_routes_a", "three_routes_c"}) {
    Scene scene(name, true);
    for (int i = 0; i < 5; ++i) {
      const std::vector<graph::PathEdge> route = scene.Proposal();
      ExpectRoute(scene, route);
      for (const graph::PathEdge& edge : route) scene.Block(edge);
    }
  }
}

TEST(LatticeExplorer, ProposesTheRouteOfTheFirstLatticeThatFindsOne) {
  for (const char* name : {"three_routes_a", "three_routes_b", "three_routes_c", "hallway",
                           "double_jump", "hallway_infeasible"}) {
    const Scene scene(name, true);
    std::vector<graph::PathEdge> expected;
    for (const LatticeSettings& settings : FirstRouteLadder()) {
      expected = scene.Search(settings);
      if (!expected.empty()) break;
    }
    const std::vector<graph::PathEdge> route = scene.Proposal();
    EXPECT_EQ(route.empty(), std::string(name) == "hallway_infeasible");
    if (!route.empty()) ExpectRoute(scene, route);
    ASSERT_EQ(route.size(), expected.size()) << name;
    for (std::size_t i = 0; i < route.size(); ++i) {
      EXPECT_EQ(route[i].action, expected[i].action);
      EXPECT_EQ(route[i].points.to, expected[i].points.to);
    }
  }
}

TEST(LatticeSearch, FindsNothingWhereThereIsNoWay) {
  EXPECT_TRUE(Scene("closed_room", false).Search(kFast).empty());
  EXPECT_TRUE(Scene("hallway_infeasible", true).Search(kFast).empty());
}

TEST(LatticeSearch, GivesUpAtTheLimitOfStances) {
  LatticeSettings settings = kFast;
  settings.most_stances = 10;
  EXPECT_TRUE(Scene("three_routes_a", false).Search(settings).empty());
}

/// A search in small portions gives the same route as a search in one go.
TEST(LatticeSearch, InterruptionAtEveryStanceGivesTheSameRoute) {
  const Scene scene("three_routes_b", false);
  const std::vector<graph::PathEdge> whole = scene.Search(kFast);
  LatticeSearch search(scene.space(), scene.start(), scene.goals(), kFast);
  while (search.Advance(1, {}) == LatticeSearch::Status::kSearching) {
  }
  const std::vector<graph::PathEdge> portions = search.Route();
  ASSERT_EQ(portions.size(), whole.size());
  for (std::size_t i = 0; i < whole.size(); ++i) {
    EXPECT_EQ(portions[i].points.to, whole[i].points.to);
  }
}

/// The lower bound without greed is no greater than that of a greedy search, and no route is
/// quicker than it.
TEST(LatticeSearch, WithoutGreedTheLowerBoundIsTheLeast) {
  for (const char* name : {"three_routes_a", "three_routes_b"}) {
    const Scene scene(name, false);
    const auto bound = [&](double greed, double known) {
      LatticeSearch search(scene.space(), scene.start(), scene.goals(),
                           {.step = 0.4, .headings = 8, .greed = greed, .most_stances = 100000});
      search.SetBound(known);
      const LatticeSearch::Status status = search.Advance(200000, {});
      EXPECT_EQ(status == LatticeSearch::Status::kFound, known > 1e3) << name << greed;
      return search.LowerBound();
    };
    const double least = bound(1, 1e6);
    EXPECT_GT(least, 10);
    EXPECT_LE(least, bound(4, 1e6) + 1e-9);
    // Given a known route that is as quick, the search finds none.
    EXPECT_NEAR(bound(1, least), least, 1e-9);
  }
}

TEST(LatticeSearch, AlwaysGivesTheSameRoute) {
  const Scene scene("double_jump", true);
  const std::vector<graph::PathEdge> once = scene.Search(kFast);
  const std::vector<graph::PathEdge> again = scene.Search(kFast);
  ASSERT_EQ(once.size(), again.size());
  for (std::size_t i = 0; i < once.size(); ++i) {
    EXPECT_EQ(once[i].action, again[i].action);
    EXPECT_EQ(once[i].points.to, again[i].points.to);
  }
}

}  // namespace
}  // namespace possibility::actions
