#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <vector>

#include "graph/search/explorer.h"
#include "graph/search/random_explorer.h"
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
using test::WayUnderTheBar;

/// Proposes a new way under the bar each turn. It goes down 0.1 m earlier each time.
class Improver : public Explorer {
 public:
  std::string name() const override { return "improver"; }
  bool TakesPart(SearchStage stage) const override { return stage == SearchStage::kImprovement; }
  Findings Explore() override {
    ++turns;
    std::vector<PathEdge> way = WayUnderTheBar();
    const Point down = MakePoint(4 - 0.1 * turns, 0.3);
    way = {{0, {Start(), MakePoint(down[0], 0.85)}},
           {1, {MakePoint(down[0], 0.85), down}},
           {1, {down, MakePoint(7, 0.3)}},
           way[3],
           way[4]};
    return {turns < 4 ? Outlook::kOpen : Outlook::kOver, way};
  }
  double work_of_turn() const override { return 1e-3; }
  bool OnRoute(const std::vector<PathEdge>& route, double duration) override {
    durations.push_back(duration);
    double sum = 0;
    for (const PathEdge& edge : route) sum += (edge.points.to - edge.points.from).norm();
    EXPECT_NEAR(sum, duration, 1e-9);
    return true;
  }
  double lower_bound() const override { return bound; }

  double bound = 8;
  int turns = 0;
  std::vector<double> durations;
};

/// Random exploration, and an explorer that shortens its routes.
class ImprovementTest : public ::testing::Test {
 protected:
  PathResult Find(double share, std::uint64_t seed) {
    FindPathSettings settings{.time_limit = 10, .seed = seed, .improvement_share = share};
    settings.explorers = {RandomExploration(), [this](const ExplorerContext&) {
                            auto improver = std::make_unique<Improver>();
                            improver_ = improver.get();
                            return improver;
                          }};
    return FindPath(Start(), {Goal()}, actions_, kRoom, settings);
  }
  const Actions actions_ = {MakeWalk(), MakeCrawl()};
  Improver* improver_ = nullptr;
};

double DurationOf(const PathResult& result) {
  double duration = 0;
  for (const PathEdge& edge : result.path) {
    duration += (edge.points.to - edge.points.from).norm();
  }
  return duration;
}

// What is below one explorer's bound may be among the other's routes.
TEST_F(ImprovementTest, TheLowerBoundOfSeveralExplorersIsTheLeastThatIsKnown) {
  const auto with_bound = [](double bound) {
    return [bound](const ExplorerContext&) {
      auto improver = std::make_unique<Improver>();
      improver->bound = bound;
      return improver;
    };
  };
  FindPathSettings settings{.time_limit = 10, .seed = 1, .improvement_share = 0.5};
  const auto bound_of = [&](std::initializer_list<double> bounds) {
    settings.explorers = {RandomExploration()};
    for (const double bound : bounds) settings.explorers.push_back(with_bound(bound));
    return FindPath(Start(), {Goal()}, actions_, kRoom, settings).lower_bound;
  };
  EXPECT_EQ(bound_of({}), 0);
  EXPECT_EQ(bound_of({0}), 0);
  EXPECT_EQ(bound_of({8, 5}), 5);
  EXPECT_EQ(bound_of({5, 0, 8}), 5);
}

TEST_F(ImprovementTest, ThePathIsAShortestPathOfTheExploredGraph) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const PathResult first = Find(0, seed);
    const PathResult result = Find(0.5, seed);
    ExpectValidPath(result, Start(), {Goal()}, actions_);
    EXPECT_NEAR(result.first_duration, first.duration, 1e-9);
    EXPECT_NEAR(result.duration, DurationOf(result), 1e-9);
    EXPECT_LE(result.duration, result.first_duration);
    EXPECT_EQ(result.lower_bound, 8);
    // Bellman-Ford over the graph as it is reported.
    const auto& vertices = result.graph.vertices;
    std::vector<double> least(vertices.size(), std::numeric_limits<double>::infinity());
    least[result.path.front().from] = 0;
    for (std::size_t round = 0; round < vertices.size(); ++round) {
      for (const GraphSnapshot::Edge& edge : result.graph.edges) {
        const double length = (vertices[edge.to] - vertices[edge.from]).norm();
        least[edge.to] = std::min(least[edge.to], least[edge.from] + length);
      }
    }
    EXPECT_NEAR(result.duration, least[result.path.back().to], 1e-9);
    for (const PathEdge& edge : result.path) {
      EXPECT_EQ(vertices[edge.from], edge.points.from);
      EXPECT_EQ(vertices[edge.to], edge.points.to);
    }
  }
}

TEST_F(ImprovementTest, TheSearchEndsBeforeTheLimitWhenNothingIsLeftToExplore) {
  const PathResult result = Find(1, 3);
  EXPECT_EQ(result.status, PathStatus::kFound);
  EXPECT_LT(result.seconds, 5);
}

TEST(Improvement, TheNearestOfSeveralGoalsIsTaken) {
  const Actions actions = {MakeWalk()};
  const std::vector<Point> goals = {MakePoint(3, 0.9), MakePoint(1, 0.8), Start()};
  const PathResult result =
      FindPath(Start(), goals, actions, kRoom, {.time_limit = 10, .straight_first = true});
  EXPECT_EQ(result.status, PathStatus::kFound);
  FindPathSettings settings{.time_limit = 10, .straight_first = true, .improvement_share = 0.1};
  EXPECT_EQ(FindPath(Start(), {goals[0], goals[1]}, actions, kRoom, settings).goal, 1);
  EXPECT_EQ(FindPath(Start(), goals, actions, kRoom, settings).goal, 2);
}

}  // namespace
}  // namespace possibility::graph
