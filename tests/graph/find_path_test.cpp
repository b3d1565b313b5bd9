#include "graph/find_path.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>

#include "tests/graph/path_checks.h"
#include "tests/graph/scripted_job.h"
#include "tests/graph/stick_figure.h"

namespace possibility::graph {
namespace {

using test::BandAction;
using test::Ending;
using test::ExpectPath;
using test::ExpectSamePath;
using test::ExpectSameResult;
using test::Goal;
using test::Interval;
using test::MakeCrawl;
using test::MakePoint;
using test::MakeWalk;
using test::ScriptedJob;
using test::Start;

using Actions = std::vector<std::shared_ptr<const Action>>;

const test::Room kRoom;

void ExpectValidPath(const PathResult& result, const Point& start, const std::vector<Point>& goals,
                     const Actions& actions) {
  ASSERT_EQ(result.status, PathStatus::kFound);
  ExpectPath(result, start, goals.at(result.goal));
  for (const PathEdge& edge : result.path) {
    EXPECT_TRUE(actions[edge.action]->CS(edge.points));
  }
}

/// Walks where jobs decide: edges that lie within a stretch of x meet only necessary conditions.
class UncertainAction : public BandAction {
 public:
  using Script = std::function<std::unique_ptr<ConfirmationJob>(const PointPair&)>;
  UncertainAction(const std::string& name, Interval band, double height, Interval uncertain,
                  Script script)
      : BandAction(name, band, height, {}), uncertain_(uncertain), script_(std::move(script)) {}
  bool CS(const PointPair& edge) const override {
    return CN(edge) && !uncertain_.Overlaps(edge.from[0], edge.to[0]);
  }
  std::unique_ptr<ConfirmationJob> SpawnConfirmationJob(const PointPair& edge) const override {
    return script_(edge);
  }
  bool Uncertain(const PointPair& edge) const {
    return uncertain_.Overlaps(edge.from[0], edge.to[0]);
  }

 private:
  Interval uncertain_;
  Script script_;
};

UncertainAction::Script Always(Ending ending, int steps) {
  return [=](const PointPair&) { return std::make_unique<ScriptedJob>(ending, steps); };
}

/// A walk that can only be done towards greater x.
class OneWayAction : public BandAction {
 public:
  OneWayAction() : BandAction("one way", {0.7, 1.0}, 0.85, {}) {}
  bool CN(const PointPair& edge) const override {
    return BandAction::CN(edge) && edge.to[0] >= edge.from[0];
  }
  bool CS(const PointPair& edge) const override { return CN(edge); }
  bool IsReversible() const override { return false; }
};

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
          PointPair{result.graph.vertices[edge.from], result.graph.vertices[edge.to]}));
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

TEST(StickFigure, WithoutPassageTheOracleEndsTheSearch) {
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

/// Over the rubble, down, under the bar, and up again.
std::vector<PathEdge> WayUnderTheBar() {
  const std::vector<std::pair<int, Point>> steps = {{0, MakePoint(3, 0.85)},
                                                    {1, MakePoint(3, 0.3)},
                                                    {1, MakePoint(7, 0.3)},
                                                    {0, MakePoint(7, 0.85)},
                                                    {0, Goal()}};
  std::vector<PathEdge> way;
  Point from = Start();
  for (const auto& [action, to] : steps) {
    way.push_back({action, {from, to}});
    from = to;
  }
  return way;
}

TEST(Suggestion, IsTakenBeforeAnythingElseIsExplored) {
  const Actions actions = {MakeWalk(), MakeCrawl()};
  FindPathSettings settings{.time_limit = 10};
  settings.suggestion = WayUnderTheBar;
  const PathResult result = FindPath(Start(), {Goal()}, actions, kRoom, settings);
  ExpectValidPath(result, Start(), {Goal()}, actions);
  EXPECT_EQ(result.path.size(), 5);
  EXPECT_EQ(result.statistics.vertices, 6);
  EXPECT_EQ(result.counters.at("walk: extend made"), 0);
}

TEST(Suggestion, OfWhatNoActionAcceptsIsWorthNothing) {
  const Actions actions = {MakeWalk(), MakeCrawl()};
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    FindPathSettings settings{.time_limit = 10, .seed = seed};
    settings.suggestion = [] {
      return std::vector<PathEdge>{{0, {Start(), Goal()}}};  // straight through the bar
    };
    const PathResult result = FindPath(Start(), {Goal()}, actions, kRoom, settings);
    ExpectValidPath(result, Start(), {Goal()}, actions);
    EXPECT_GT(result.path.size(), 1);
  }
}

TEST(Suggestion, IsAPlaceToGrowFromAsFarAsItGoes) {
  const Actions actions = {MakeWalk(), MakeCrawl()};
  FindPathSettings settings{.time_limit = 10};
  settings.suggestion = [] {
    std::vector<PathEdge> way = WayUnderTheBar();
    way.resize(3);
    return way;
  };
  const PathResult result = FindPath(Start(), {Goal()}, actions, kRoom, settings);
  ExpectValidPath(result, Start(), {Goal()}, actions);
  EXPECT_EQ(result.graph.vertices[4], MakePoint(7, 0.3));  // after start, goal and two more
}

TEST(Suggestion, IfThereIsNoneTheOracleIsAskedAtOnce) {
  FindPathSettings settings{.time_limit = 10, .max_cycles = 80, .ask_oracle_after = 50};
  settings.suggestion = [] { return std::vector<PathEdge>(); };
  settings.oracle = [] { return RouteOracleAnswer::kExhausted; };
  const PathResult result =
      FindPath(Start(), {Goal()}, {MakeWalk(), MakeCrawl(true)}, kRoom, settings);
  EXPECT_EQ(result.status, PathStatus::kExhausted);
  EXPECT_EQ(result.counters.at("walk: extend made"), 0);
}

TEST(Suggestion, IsAskedForAgainWhenItsEdgesAreRefuted) {
  const auto leap = std::make_shared<UncertainAction>("leap", Interval{0.7, 1.0}, 0.85,
                                                      Interval{4, 6}, Always(Ending::kRefute, 2));
  const Actions actions = {leap, MakeCrawl()};
  int asked = 0;
  FindPathSettings settings{.time_limit = 10};
  settings.suggestion = [&asked] {
    if (++asked > 1) return WayUnderTheBar();
    return std::vector<PathEdge>{{0, {Start(), Goal()}}};
  };
  const PathResult result = FindPath(Start(), {Goal()}, actions, kRoom, settings);
  ExpectValidPath(result, Start(), {Goal()}, actions);
  EXPECT_EQ(asked, 2);
}

TEST(StraightFirst, IsThePathWhereAnActionIsSureOfIt) {
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

TEST(StraightFirst, ChangesNothingWhereNoActionIsSure) {
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

TEST(StraightFirst, KeepsToTheTimeLimitAndStaysWhereTheGoalIsTheStart) {
  const Point near = MakePoint(3, 0.85);
  FindPathSettings settings{.time_limit = 0, .straight_first = true};
  EXPECT_EQ(FindPath(Start(), {near}, {MakeWalk()}, kRoom, settings).status,
            PathStatus::kTimeLimit);
  settings.time_limit = 10;
  const PathResult result = FindPath(Start(), {Start()}, {MakeWalk()}, kRoom, settings);
  EXPECT_EQ(result.status, PathStatus::kFound);
  EXPECT_TRUE(result.path.empty());
}

TEST(FindPath, AnyReachableGoalWillDo) {
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

/// The least overshoot of a few searches, s: the machine may be busy with something else.
double LeastOvershoot(const Actions& actions, const FindPathSettings& settings) {
  double least = std::numeric_limits<double>::infinity();
  for (int attempt = 0; attempt < 10 && least >= 0.05; ++attempt) {
    const PathResult result = FindPath(Start(), {Goal()}, actions, kRoom, settings);
    EXPECT_EQ(result.status, PathStatus::kTimeLimit);
    EXPECT_GE(result.seconds, settings.time_limit);
    least = std::min(least, result.seconds - settings.time_limit);
  }
  return least;
}

TEST(FindPath, TheTimeLimitIsObeyed) {
  for (const double limit : {0.0, 0.1, 0.3}) {
    EXPECT_LT(LeastOvershoot({MakeWalk(), MakeCrawl(true)}, {.time_limit = limit}), 0.05);
  }
}

TEST(FindPath, AnExtensionThatStandsStillEndsConnect) {
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

class WithJobs : public ::testing::TestWithParam<int> {
 protected:
  FindPathSettings Settings() const {
    return {.time_limit = 10, .confirmation_threads = GetParam()};
  }
};
INSTANTIATE_TEST_SUITE_P(FindPath, WithJobs, ::testing::Values(0, 2));

TEST_P(WithJobs, AnIndeterminateEdgeIsReturnedOnlyAfterItsJobConfirmed) {
  const auto walk = std::make_shared<UncertainAction>("walk", Interval{0.7, 1}, 0.85,
                                                      Interval{4, 6}, Always(Ending::kConfirm, 5));
  const PathResult result = FindPath(Start(), {Goal()}, {walk}, kRoom, Settings());
  ASSERT_EQ(result.status, PathStatus::kFound);
  int uncertain = 0;
  for (const PathEdge& edge : result.path) {
    if (!walk->Uncertain(edge.points)) {
      continue;
    }
    ++uncertain;
    bool confirmed = false;
    for (const ConfirmationReport& report : result.confirmations) {
      const PointPair& points = report.points;
      confirmed = confirmed || (report.outcome == JobOutcome::kConfirmed &&
                                ((points.from == edge.points.from && points.to == edge.points.to) ||
                                 (points.from == edge.points.to && points.to == edge.points.from)));
    }
    EXPECT_TRUE(confirmed);
  }
  EXPECT_GT(uncertain, 0);
  EXPECT_GE(result.counters.at("jobs confirmed"), uncertain);
  EXPECT_EQ(result.counters.at("jobs refuted"), 0);
  EXPECT_GE(result.counters.at("jobs spawned"), result.counters.at("jobs confirmed"));
}

TEST_P(WithJobs, ARefutedFailedOrEndlessRouteIsReplacedByAnother) {
  for (const Ending ending :
       {Ending::kRefute, Ending::kThrow, Ending::kNever, Ending::kGiveUp, Ending::kNonsense}) {
    const auto walk = std::make_shared<UncertainAction>("walk", Interval{0.7, 1}, 0.85,
                                                        Interval{4, 6}, Always(ending, 3));
    const Actions actions = {walk, MakeCrawl()};
    FindPathSettings settings = Settings();
    settings.confirmation_job_limit = 0.05;
    const PathResult result = FindPath(Start(), {Goal()}, actions, kRoom, settings);
    ExpectValidPath(result, Start(), {Goal()}, actions);
    EXPECT_EQ(result.counters.at("jobs confirmed"), 0);
    EXPECT_EQ(result.counters.at("jobs spawned"), static_cast<int>(result.confirmations.size()));
    for (const ConfirmationReport& report : result.confirmations) {
      EXPECT_EQ(report.action, 0);
      EXPECT_FALSE(report.reason.empty());
      const bool refuted = report.outcome == JobOutcome::kRefuted;
      EXPECT_EQ(refuted, ending == Ending::kRefute && report.outcome != JobOutcome::kCancelled);
    }
  }
}

TEST_P(WithJobs, AnEdgeIsExaminedOnlyOnce) {
  std::vector<PointPair> spawned;
  const auto script = [&](const PointPair& edge) {
    spawned.push_back(edge);
    return std::make_unique<ScriptedJob>(Ending::kRefute, 1);
  };
  const auto walk =
      std::make_shared<UncertainAction>("walk", Interval{0.7, 1}, 0.85, Interval{4.9, 5.1}, script);
  FindPathSettings settings = Settings();
  settings.max_cycles = 150;
  const PathResult result = FindPath(Start(), {Goal()}, {walk}, kRoom, settings);
  EXPECT_EQ(result.status, PathStatus::kTimeLimit);
  ASSERT_GT(spawned.size(), 1);
  for (std::size_t i = 0; i < spawned.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_FALSE(spawned[i].from == spawned[j].from && spawned[i].to == spawned[j].to);
      EXPECT_FALSE(spawned[i].from == spawned[j].to && spawned[i].to == spawned[j].from);
    }
  }
  EXPECT_EQ(result.counters.at("jobs refuted"), static_cast<int>(spawned.size()));
}

TEST_P(WithJobs, AnotherActionMayConfirmWhatTheFirstCannot) {
  const Interval band = {0.7, 1};
  const auto walk = std::make_shared<UncertainAction>("walk", band, 0.85, Interval{4, 6},
                                                      Always(Ending::kRefute, 2));
  const auto stoop = std::make_shared<UncertainAction>("stoop", band, 0.85, Interval{0, 10},
                                                       Always(Ending::kConfirm, 2));
  const PathResult result = FindPath(Start(), {Goal()}, {walk, stoop}, kRoom, Settings());
  ASSERT_EQ(result.status, PathStatus::kFound);
  for (const PathEdge& edge : result.path) {
    if (walk->Uncertain(edge.points)) {
      EXPECT_EQ(edge.action, 1);
    }
  }
}

TEST_P(WithJobs, AnEdgeWithoutJobStaysOut) {
  const auto walk = std::make_shared<UncertainAction>(
      "walk", Interval{0.7, 1}, 0.85, Interval{4, 6}, [](const PointPair&) { return nullptr; });
  FindPathSettings settings = Settings();
  settings.max_cycles = 50;
  const PathResult result = FindPath(Start(), {Goal()}, {walk}, kRoom, settings);
  EXPECT_EQ(result.status, PathStatus::kTimeLimit);
  EXPECT_GT(result.counters.at("edges without job"), 0);
  EXPECT_EQ(result.counters.at("jobs spawned"), 0);
}

TEST_P(WithJobs, JobsThatNeverEndDoNotHoldUpTheTimeLimit) {
  int spawned = 0;
  const auto script = [&](const PointPair&) {
    ++spawned;
    return std::make_unique<ScriptedJob>(Ending::kNever, 0, std::chrono::milliseconds(5));
  };
  const auto walk =
      std::make_shared<UncertainAction>("walk", Interval{0.7, 1}, 0.85, Interval{4, 6}, script);
  FindPathSettings settings = Settings();
  settings.time_limit = 0.3;
  EXPECT_LT(LeastOvershoot({walk}, settings), 0.05);
  EXPECT_GT(spawned, 0);
}

/// A search of so many cycles whose jobs have so many checkpoints, a pause after each.
PathResult SearchWithJobsOf(int checkpoints, int cycles, std::chrono::microseconds pause) {
  const auto walk = std::make_shared<UncertainAction>(
      "walk", Interval{0.7, 1}, 0.85, Interval{4, 6}, [=](const PointPair& edge) {
        const bool good = edge.from[1] > 0.72;
        return std::make_unique<ScriptedJob>(good ? Ending::kConfirm : Ending::kRefute, checkpoints,
                                             pause);
      });
  return FindPath(Start(), {Goal()}, {walk}, kRoom,
                  {.time_limit = 60, .seed = 5, .max_cycles = cycles});
}

void ExpectTheSameHoweverSlow(int checkpoints, int cycles) {
  const PathResult quick = SearchWithJobsOf(checkpoints, cycles, std::chrono::microseconds(0));
  const PathResult slow = SearchWithJobsOf(checkpoints, cycles, std::chrono::microseconds(20));
  ASSERT_EQ(quick.status, PathStatus::kFound);
  EXPECT_EQ(quick.counters, slow.counters);
  EXPECT_GT(quick.counters.at("jobs refuted"), 0);
  ExpectSamePath(quick, slow);
}

TEST(FindPath, JobsWithoutThreadsAreReproducible) { ExpectTheSameHoweverSlow(7, -1); }

TEST(FindPath, JobsThatOutliveTheirTurnsAreReproducible) { ExpectTheSameHoweverSlow(1200, 30); }

}  // namespace
}  // namespace possibility::graph
