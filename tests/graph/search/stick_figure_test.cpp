#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "graph/search/find_path.h"
#include "tests/graph/path_checks.h"
#include "tests/graph/search/searches.h"

namespace possibility::graph {
namespace {

using test::Actions;
using test::ExpectSameResult;
using test::ExpectValidPath;
using test::Goal;
using test::kRoom;
using test::MakeCrawl;
using test::MakeWalk;
using test::Start;

TEST(StickFigure, CrawlsUnderTheBarWithEverySeed) {
  const Actions actions = {MakeWalk(), MakeCrawl()};
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    FindPathSettings settings{.time_limit = 10, .seed = seed};
    const PathResult result = FindPath(Start(), {Goal()}, actions, kRoom, settings);
    ExpectValidPath(result, Start(), {Goal()}, actions);
    bool crawled = false;
    for (const PathEdge& edge : result.path) {
      crawled = crawled || edge.points.from[1] <= 0.4;
    }
    EXPECT_TRUE(crawled);
    EXPECT_GT(result.counters.at("crawl: transition made"), 0);
    EXPECT_GT(result.counters.at("edges confirmed by C_S"), 0);
    EXPECT_EQ(result.statistics.vertices, static_cast<int>(result.graph.vertices.size()));
    for (const GraphSnapshot::Edge& edge : result.graph.edges) {
      EXPECT_TRUE(actions[edge.action]->CN(
          Edge{result.graph.vertices[edge.from], result.graph.vertices[edge.to]}));
    }
  }
}

TEST(StickFigure, NoTwoVerticesAreTheSamePoint) {
  const PathResult result = FindPath(Start(), {Goal()}, {MakeWalk(), MakeCrawl(true)}, kRoom,
                                     {.time_limit = 10, .max_cycles = 60});
  const auto& vertices = result.graph.vertices;
  ASSERT_GT(vertices.size(), 100);
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_GE((vertices[i] - vertices[j]).norm(), 1e-9);
    }
  }
}

TEST(StickFigure, WithoutAPassageTheOraclesNoEndsTheSearch) {
  for (const auto& [answer, status] :
       {std::pair{RouteOracleAnswer::kExhausted, PathStatus::kExhausted},
        std::pair{RouteOracleAnswer::kProvenInfeasible, PathStatus::kProvenInfeasible},
        std::pair{RouteOracleAnswer::kUnknown, PathStatus::kTimeLimit}}) {
    int asked = 0;
    FindPathSettings settings{.time_limit = 10, .max_cycles = 80, .ask_oracle_after = 50};
    settings.oracle = [&asked, answer = answer] {
      ++asked;
      return answer;
    };
    const PathResult result =
        FindPath(Start(), {Goal()}, {MakeWalk(), MakeCrawl(true)}, kRoom, settings);
    EXPECT_EQ(result.status, status);
    EXPECT_EQ(asked, 1);
    EXPECT_EQ(result.statistics.cycles, answer == RouteOracleAnswer::kUnknown ? 80 : 50);
    EXPECT_TRUE(result.path.empty());
    EXPECT_EQ(result.goal, -1);
  }
}

TEST(StickFigure, WhereTheOracleCannotTellTheSearchEndsAfterItsEffort) {
  for (const std::int64_t turns : {0, 30}) {
    FindPathSettings settings{
        .time_limit = 10, .ask_oracle_after = 50, .turns_after_oracle = turns};
    settings.oracle = [] { return RouteOracleAnswer::kUnknown; };
    const PathResult result =
        FindPath(Start(), {Goal()}, {MakeWalk(), MakeCrawl(true)}, kRoom, settings);
    EXPECT_EQ(result.status, PathStatus::kExhausted);
    EXPECT_EQ(result.statistics.cycles, 50 + turns + 1) << "the last turn finds that it is over";
    // A search that its own limit ends first has not spent the effort.
    settings.max_cycles = 50 + turns;
    const PathResult cut =
        FindPath(Start(), {Goal()}, {MakeWalk(), MakeCrawl(true)}, kRoom, settings);
    EXPECT_EQ(cut.status, PathStatus::kTimeLimit);
  }
}

TEST(StickFigure, TheSameSeedGivesTheSameResult) {
  const Actions actions = {MakeWalk(), MakeCrawl()};
  const auto run = [&](std::uint64_t seed) {
    return FindPath(Start(), {Goal()}, actions, kRoom, {.time_limit = 10, .seed = seed});
  };
  const PathResult a = run(3);
  const PathResult b = run(3);
  ExpectSameResult(a, b);
  EXPECT_NE(a.graph.vertices.size(), run(4).graph.vertices.size());
}

}  // namespace
}  // namespace possibility::graph
