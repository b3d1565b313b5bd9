#include "graph/search/straight_path.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/graph/path_checks.h"
#include "tests/graph/search/searches.h"

namespace possibility::graph {
namespace {

using test::Actions;
using test::ExpectValidPath;
using test::Goal;
using test::kRoom;
using test::MakeCrawl;
using test::MakePoint;
using test::MakeWalk;
using test::Start;

TEST(StraightFirst, AStraightWayThatMeetsCSIsThePath) {
  const Actions actions = {MakeCrawl(), MakeWalk()};
  const Point near = MakePoint(3, 0.85);
  FindPathSettings settings{.time_limit = 10, .straight_first = true};
  const PathResult result = FindPath(Start(), {Goal(), near}, actions, kRoom, settings);
  ExpectValidPath(result, Start(), {Goal(), near}, actions);
  EXPECT_EQ(result.goal, 1);
  ASSERT_EQ(result.path.size(), 1);
  EXPECT_EQ(result.path[0].action, 1);
  EXPECT_EQ(result.statistics.cycles, 0);
  EXPECT_EQ(result.statistics.vertices, static_cast<int>(result.graph.vertices.size()));
  EXPECT_EQ(result.statistics.edges, static_cast<int>(result.graph.edges.size()));
  EXPECT_EQ(result.counters.at("edges confirmed by C_S"), 1);
}

TEST(StraightFirst, ChangesNothingWhereNoStraightWayMeetsCS) {
  const Actions actions = {MakeWalk(), MakeCrawl()};
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    FindPathSettings settings{.time_limit = 10, .seed = seed};
    const PathResult without = FindPath(Start(), {Goal()}, actions, kRoom, settings);
    settings.straight_first = true;
    const PathResult with = FindPath(Start(), {Goal()}, actions, kRoom, settings);
    ExpectValidPath(with, Start(), {Goal()}, actions);
    EXPECT_EQ(with.counters, without.counters);
    EXPECT_EQ(with.path.size(), without.path.size());
  }
}

TEST(StraightFirst, KeepsToTheTimeLimitAndAStartThatIsTheGoalNeedsNoEdge) {
  const Point near = MakePoint(3, 0.85);
  FindPathSettings settings{.time_limit = 0, .straight_first = true};
  EXPECT_EQ(FindPath(Start(), {near}, {MakeWalk()}, kRoom, settings).status,
            PathStatus::kTimeLimit);
  settings.time_limit = 10;
  const PathResult result = FindPath(Start(), {Start()}, {MakeWalk()}, kRoom, settings);
  EXPECT_EQ(result.status, PathStatus::kFound);
  EXPECT_TRUE(result.path.empty());
}

}  // namespace
}  // namespace possibility::graph
