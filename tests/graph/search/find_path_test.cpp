#include "graph/search/find_path.h"

#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <stdexcept>

#include "graph/search/random_explorer.h"
#include "tests/graph/search/searches.h"

namespace possibility::graph {
namespace {

using test::Actions;
using test::BandAction;
using test::ExpectValidPath;
using test::Goal;
using test::Interval;
using test::kRoom;
using test::LeastOvershoot;
using test::MakeCrawl;
using test::MakePoint;
using test::MakeWalk;
using test::Start;
using test::UncertainAction;

/// A walk that is only possible towards greater x.
class OneWayAction : public BandAction {
 public:
  OneWayAction() : BandAction("one way", {0.7, 1.0}, 0.85, {}) {}
  bool CN(const Edge& edge) const override {
    return BandAction::CN(edge) && edge.to[0] >= edge.from[0];
  }
  bool CS(const Edge& edge) const override { return CN(edge); }
  bool IsReversible() const override { return false; }
};

TEST(FindPath, APathToAnyReachableGoalIsFound) {
  const Point unreachable = MakePoint(5, 0.05);
  const std::vector<Point> goals = {unreachable, Goal(), MakePoint(3, 0.3)};
  const Actions actions = {MakeWalk(), MakeCrawl()};
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const PathResult result =
        FindPath(Start(), goals, actions, kRoom, {.time_limit = 10, .seed = seed});
    ExpectValidPath(result, Start(), goals, actions);
    EXPECT_NE(result.goal, 0);
  }
}

TEST(FindPath, AStartThatIsAGoalNeedsNoEdge) {
  const PathResult result =
      FindPath(Start(), {Goal(), Start()}, {MakeWalk()}, kRoom, {.time_limit = 10});
  EXPECT_EQ(result.status, PathStatus::kFound);
  EXPECT_EQ(result.goal, 1);
  EXPECT_TRUE(result.path.empty());
}

TEST(FindPath, IrreversibleActionsGrowFromBothEndsInTheDirectionOfExecution) {
  const Actions actions = {std::make_shared<OneWayAction>()};
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const PathResult there =
        FindPath(Start(), {Goal()}, actions, kRoom, {.time_limit = 10, .seed = seed});
    ExpectValidPath(there, Start(), {Goal()}, actions);
    const PathResult back = FindPath(Goal(), {Start()}, actions, kRoom,
                                     {.time_limit = 10, .seed = seed, .max_cycles = 100});
    EXPECT_EQ(back.status, PathStatus::kTimeLimit);
  }
}

TEST(FindPath, TheTimeLimitIsObeyed) {
  for (const double limit : {0.0, 0.1, 0.3}) {
    EXPECT_LT(LeastOvershoot({MakeWalk(), MakeCrawl(true)}, {.time_limit = limit}), 0.05);
  }
}

TEST(FindPath, AnExtensionThatDoesNotMoveAddsNoVertex) {
  class Stuck : public BandAction {
   public:
    Stuck() : BandAction("stuck", {0, 1}, 0.5, {}) {}
    Point ExtendTowards(const Point& v0, const Point&) const override { return v0; }
  };
  const PathResult result = FindPath(Start(), {Goal()}, {std::make_shared<Stuck>()}, kRoom,
                                     {.time_limit = 10, .max_cycles = 20});
  EXPECT_EQ(result.status, PathStatus::kTimeLimit);
  EXPECT_EQ(result.statistics.cycles, 20);
  EXPECT_EQ(result.statistics.vertices, 2);
}

TEST(FindPath, ProgressIsReported) {
  int calls = 0;
  FindPathSettings settings{.time_limit = 0.35};
  settings.progress = [&](const FindPathProgress& progress) {
    ++calls;
    EXPECT_GT(progress.cycles, 0);
  };
  FindPath(Start(), {Goal()}, {MakeWalk(), MakeCrawl(true)}, kRoom, settings);
  EXPECT_GE(calls, 1);
  EXPECT_LE(calls, 4);
}

TEST(FindPath, InvalidArgumentsThrow) {
  const Actions walk = {MakeWalk()};
  const auto expect_throw = [&](const Point& start, const std::vector<Point>& goals,
                                const Actions& actions, const FindPathSettings& settings) {
    EXPECT_THROW(FindPath(start, goals, actions, kRoom, settings), std::invalid_argument);
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  expect_throw(Start(), {}, walk, {});
  expect_throw(Start(), {Goal()}, {}, {});
  expect_throw(Start(), {Goal()}, {nullptr}, {});
  expect_throw(Point(), {Goal()}, walk, {});
  expect_throw(Start(), {Point::Zero(3)}, walk, {});
  expect_throw(Start(), {MakePoint(nan, 1)}, walk, {});
  expect_throw(MakePoint(nan, 1), {Goal()}, walk, {});
  expect_throw(Start(), {Goal()}, walk, {.time_limit = -1});
  expect_throw(Start(), {Goal()}, walk, {.time_limit = nan});
  expect_throw(Start(), {Goal()}, walk, {.max_transitions_per_cycle = -1});
  expect_throw(Start(), {Goal()}, walk, {.confirmation_threads = -1});
  expect_throw(Start(), {Goal()}, walk, {.confirmation_job_limit = 0});
  expect_throw(Start(), {Goal()}, walk, {.skip_growth = {{"wlak", 0.5}}});
  expect_throw(Start(), {Goal()}, walk, {.skip_growth = {{"walk", 1.5}}});
  expect_throw(Start(), {Goal()}, walk, {.skip_growth = {{"walk", nan}}});
}

TEST(FindPath, AFullGraphEndsRandomExplorationEarly) {
  const auto walk = std::make_shared<UncertainAction>(
      "walk", Interval{0.7, 1}, 0.85, Interval{4, 6}, [](const Edge&) { return nullptr; });
  const PathResult result =
      FindPath(Start(), {Goal()}, {walk}, kRoom, {.time_limit = 600, .max_graph_size = 500});
  EXPECT_EQ(result.status, PathStatus::kTimeLimit);
  EXPECT_LT(result.seconds, 300);
  EXPECT_EQ(result.counters.at(kGraphIsFull), 1);
  const auto size = result.graph.vertices.size() + result.graph.edges.size();
  EXPECT_GT(size, 400);
  EXPECT_LT(size, 600);
}

}  // namespace
}  // namespace possibility::graph
