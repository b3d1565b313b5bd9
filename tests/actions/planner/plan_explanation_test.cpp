#include "actions/planner/plan_explanation.h"

#include <gtest/gtest.h>

#include "tests/actions/leap.h"

namespace possibility::actions {
namespace {

Barrier At(double x, const std::vector<std::string>& closed_by) {
  Barrier barrier;
  barrier.closest = {x, -0.254};
  barrier.distance = 1.5;
  barrier.closed_by = closed_by;
  return barrier;
}

TEST(PlanExplanationTest, ABarrierIsExplainedByItsPlaceAndObstacles) {
  EXPECT_EQ(ExplainBarrier(PlanStatus::kExhausted, At(2, {"bar", "no ground"})),
            "no route exists that these actions could confirm: the search came within 1.50 m of a "
            "goal, at (2.00, -0.25); the way on is closed by bar, no ground.");
  EXPECT_EQ(ExplainBarrier(PlanStatus::kProvenInfeasible, At(2, {})),
            "no route exists within the scenario's bounds, not even for the pelvis alone: the "
            "search came within 1.50 m of a goal, at (2.00, -0.25); the way on is closed by the "
            "bounds.");
}

TEST(PlanExplanationTest, ASearchIsExplainedByItsCounters) {
  EXPECT_EQ(ExplainSearch({{"cycles", 0}, {"vertices", 2}}), "");
  EXPECT_EQ(ExplainSearch({{"cycles", 7}, {"edges", 0}, {"vertices", 2}, {"jobs spawned", 0}}),
            " The search went through 7 cycles and knows 2 places and 0 ways between them.");
  EXPECT_EQ(
      ExplainSearch({{"cycles", 1},
                     {"vertices", 1},
                     {"edges", 1},
                     {"walk: extend rejected at vertex", 20},
                     {"walk: extend rejected on edge", 0},
                     {"walk: extend made", 3000},
                     {"crawl: extend rejected on edge", 400},
                     {"vault: growth not lined up", 21},
                     {"vault: growth rejected", 5},
                     {"jobs spawned", 4},
                     {"jobs confirmed", 1},
                     {"jobs refuted", 3}}),
      " The search went through 1 cycle and knows 1 place and 1 way between them. Most often: "
      "400 ways that 'crawl' cannot go; 21 tries of 'vault' to which no way leads; 20 places "
      "where 'walk' cannot be. Of 4 confirmation jobs, 1 confirmed, 3 refuted, 0 failed and 0 "
      "not needed any more.");
}

/// Four places: the start, one ahead, a farther one that only leads back, and the goal.
ExploredGraph Explored(const std::vector<ExploredGraph::Edge>& edges) {
  ExploredGraph graph;
  for (const double x : {0.0, 1.0, 3.0, 4.0}) graph.vertices.push_back({{x, 0.5, 0.7}, 0});
  graph.edges = edges;
  return graph;
}

TEST(PlanExplanationTest, TheClosestPlaceIsReachableFromTheStart) {
  const std::vector<models::Stance> goals = {{"walk", 9, 0.5, 0, 0}, {"walk", 4, 0.5, 0, 0}};
  EXPECT_EQ(ExplainClosest(Explored({}), goals), "");
  EXPECT_EQ(ExplainClosest({}, goals), "");
  EXPECT_EQ(ExplainClosest(Explored({{0, 1, "walk"}, {2, 1, "walk"}}), goals),
            " It came within 3.00 m of a goal, at (1.00, 0.50).");
  EXPECT_EQ(ExplainClosest(Explored({{0, 1, "walk"}, {1, 2, "walk"}}), goals),
            " It came within 1.00 m of a goal, at (3.00, 0.50).");
  EXPECT_EQ(ExplainClosest(Explored({{0, 3, "walk"}}), goals),
            " Ways were explored as far as a goal, but none of them could be confirmed in time.");
}

TEST(PlanExplanationTest, ManoeuvresAreExplainedByTheirFirstFewRefusals) {
  const Context context(PitScene(true).environment);
  const auto leap = std::make_shared<SearchedManoeuvre>(std::make_shared<Leap>(
      *context, [](graph::JobControl*) { return graph::JobVerdict::kRefuted; },
      [](const Leap& l) { return l.Slide(); }));
  EXPECT_EQ(ExplainManoeuvres({leap}, {}), "");
  const auto edge = [](double x) {
    return graph::Edge{ToPoint(PlanarPose{x, 1, 0}.At(1)), ToPoint(PlanarPose{x, 2, 0}.At(1))};
  };
  leap->Forbid(edge(0), "a wall", false);
  EXPECT_EQ(ExplainManoeuvres({leap}, {}), " 1 of 'vault' refuted: from (0.00, 1.00): a wall.");
  for (int i = 1; i < 5; ++i) leap->Forbid(edge(i), "r" + std::to_string(i), false);
  EXPECT_EQ(ExplainManoeuvres({leap}, {{"vault", {{edge(9), "it threw"}}}, {"hop", {{}}}}),
            " 5 of 'vault' refuted: from (0.00, 1.00): a wall; from (1.00, 1.00): r1; from (2.00, "
            "1.00): r2; ... 1 job of 'vault' failed: from (9.00, 1.00): it threw.");
}

}  // namespace
}  // namespace possibility::actions
