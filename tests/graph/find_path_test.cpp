#include "graph/find_path.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <thread>

#include "graph/random_explorer.h"
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

/// A walk that needs jobs: edges within a stretch of x meet only the necessary conditions.
class UncertainAction : public BandAction {
 public:
  using Script = std::function<std::unique_ptr<ConfirmationJob>(const Edge&)>;
  UncertainAction(const std::string& name, Interval band, double height, Interval uncertain,
                  Script script)
      : BandAction(name, band, height, {}), uncertain_(uncertain), script_(std::move(script)) {}
  bool CS(const Edge& edge) const override {
    return CN(edge) && !uncertain_.Overlaps(edge.from[0], edge.to[0]);
  }
  std::unique_ptr<ConfirmationJob> SpawnConfirmationJob(const Edge& edge) const override {
    return script_(edge);
  }
  bool Uncertain(const Edge& edge) const { return uncertain_.Overlaps(edge.from[0], edge.to[0]); }

 private:
  Interval uncertain_;
  Script script_;
};

UncertainAction::Script Always(Ending ending, int steps) {
  return [=](const Edge&) { return std::make_unique<ScriptedJob>(ending, steps); };
}

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

/// Proposes routes of a script, one per turn.
class ScriptedExplorer : public Explorer {
 public:
  using Script = std::function<Findings()>;
  explicit ScriptedExplorer(Script script) : script_(std::move(script)) {}
  std::string name() const override { return "script"; }
  bool TakesPart(SearchStage stage) const override { return stage == SearchStage::kFirstRoute; }
  Findings Explore() override { return script_(); }
  double work_of_turn() const override { return 1e-3; }
  bool OnRefuted() override { return true; }

 private:
  Script script_;
};

/// A scripted explorer first, then the paper's exploration.
std::vector<ExplorerFactory> First(const ScriptedExplorer::Script& script) {
  return {[script](const ExplorerContext&) { return std::make_unique<ScriptedExplorer>(script); },
          RandomExploration()};
}

TEST(Explorers, TheFirstExplorerIsAskedBeforeTheOthers) {
  const Actions actions = {MakeWalk(), MakeCrawl()};
  FindPathSettings settings{.time_limit = 10};
  settings.explorers = First([] { return Findings{Outlook::kOver, WayUnderTheBar()}; });
  const PathResult result = FindPath(Start(), {Goal()}, actions, kRoom, settings);
  ExpectValidPath(result, Start(), {Goal()}, actions);
  EXPECT_EQ(result.path.size(), 5);
  EXPECT_EQ(result.statistics.vertices, 6);
  EXPECT_EQ(result.counters.at("walk: extend made"), 0);
  EXPECT_EQ(result.found_by, std::vector<std::string>{"script"});
}

TEST(Explorers, ProposedEdgesThatNoActionAcceptsAreDropped) {
  const Actions actions = {MakeWalk(), MakeCrawl()};
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    FindPathSettings settings{.time_limit = 10, .seed = seed};
    settings.explorers = First([] {
      return Findings{Outlook::kOver, {{0, {Start(), Goal()}}}};  // straight through the bar
    });
    const PathResult result = FindPath(Start(), {Goal()}, actions, kRoom, settings);
    ExpectValidPath(result, Start(), {Goal()}, actions);
    EXPECT_GT(result.path.size(), 1);
    EXPECT_EQ(result.found_by, std::vector<std::string>{"random"});
  }
}

TEST(Explorers, VerticesFoundByOneAreUsedByTheOthers) {
  const Actions actions = {MakeWalk(), MakeCrawl()};
  FindPathSettings settings{.time_limit = 10};
  settings.explorers = First([] {
    std::vector<PathEdge> way = WayUnderTheBar();
    way.resize(3);
    return Findings{Outlook::kOver, way};
  });
  const PathResult result = FindPath(Start(), {Goal()}, actions, kRoom, settings);
  ExpectValidPath(result, Start(), {Goal()}, actions);
  EXPECT_EQ(result.graph.vertices[4], MakePoint(7, 0.3));  // after start, goal and two more
  EXPECT_EQ(result.found_by.size(), 2);
}

TEST(Explorers, AnExplorerThatLeadsOnHasTheTurnAlone) {
  const Actions actions = {MakeWalk(), MakeCrawl()};
  for (const Outlook outlook : {Outlook::kLeadsOn, Outlook::kOpen}) {
    int turns = 0;
    FindPathSettings settings{.time_limit = 10, .max_cycles = 5};
    settings.explorers = First([&] {
      ++turns;
      return Findings{outlook, {}};
    });
    const PathResult result = FindPath(Start(), {MakePoint(5, 0.05)}, actions, kRoom, settings);
    EXPECT_EQ(turns, 5);
    EXPECT_EQ(result.counters.at("walk: extend made") > 0, outlook == Outlook::kOpen);
  }
}

TEST(Explorers, TheOracleIsAskedAtOnceWhenAnExplorerIsOver) {
  FindPathSettings settings{.time_limit = 10, .max_cycles = 80, .ask_oracle_after = 50};
  settings.explorers = First([] { return Findings{Outlook::kOver, {}}; });
  settings.oracle = [] { return RouteOracleAnswer::kExhausted; };
  const PathResult result =
      FindPath(Start(), {Goal()}, {MakeWalk(), MakeCrawl(true)}, kRoom, settings);
  EXPECT_EQ(result.status, PathStatus::kExhausted);
  EXPECT_EQ(result.counters.at("walk: extend made"), 0);
}

TEST(Explorers, AreAskedAgainWhenJobsRefuteEdges) {
  const auto leap = std::make_shared<UncertainAction>("leap", Interval{0.7, 1.0}, 0.85,
                                                      Interval{4, 6}, Always(Ending::kRefute, 2));
  const Actions actions = {leap, MakeCrawl()};
  int asked = 0;
  FindPathSettings settings{.time_limit = 10};
  settings.explorers = First([&asked] {
    if (++asked > 1) return Findings{Outlook::kOver, WayUnderTheBar()};
    return Findings{Outlook::kOver, {{0, {Start(), Goal()}}}};
  });
  const PathResult result = FindPath(Start(), {Goal()}, actions, kRoom, settings);
  ExpectValidPath(result, Start(), {Goal()}, actions);
  EXPECT_EQ(asked, 2);
}

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
class ImprovementTest : public testing::Test {
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

/// An action whose conditions take longer than it declares.
class SlowAction : public UncertainAction {
 public:
  using UncertainAction::UncertainAction;
  bool CN(const Point& vertex) const override {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    return UncertainAction::CN(vertex);
  }
  bool CN(const Edge& edge) const override { return UncertainAction::CN(edge); }
};

TEST(Turns, OfJobsComeInTimeDespiteSlowConditions) {
  // The job takes two turns. The first, of 1000 steps, gives no verdict.
  const auto job = [](const Edge&) {
    return std::make_unique<ScriptedJob>(Ending::kConfirm, 1500, std::chrono::microseconds(500));
  };
  const Actions actions = {
      std::make_shared<SlowAction>("leap", Interval{0.7, 1.0}, 0.85, Interval{4.5, 4.6}, job)};
  const PathResult result = FindPath(Start(), {Goal()}, actions, kRoom, {.time_limit = 20});
  EXPECT_EQ(result.status, PathStatus::kFound);
  EXPECT_GE(result.counters.at("jobs confirmed"), 1);
  EXPECT_LT(result.statistics.cycles, 1000);
}

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

/// The least overshoot of a few searches, s, since the machine may be busy with something else.
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
      const Edge& points = report.points;
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
  std::vector<Edge> spawned;
  const auto script = [&](const Edge& edge) {
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

TEST_P(WithJobs, AnIndeterminateEdgeWithoutJobIsNotUsed) {
  const auto walk = std::make_shared<UncertainAction>(
      "walk", Interval{0.7, 1}, 0.85, Interval{4, 6}, [](const Edge&) { return nullptr; });
  FindPathSettings settings = Settings();
  settings.max_cycles = 50;
  const PathResult result = FindPath(Start(), {Goal()}, {walk}, kRoom, settings);
  EXPECT_EQ(result.status, PathStatus::kTimeLimit);
  EXPECT_GT(result.counters.at("edges without job"), 0);
  EXPECT_EQ(result.counters.at("jobs spawned"), 0);
}

TEST_P(WithJobs, JobsThatNeverEndDoNotHoldUpTheTimeLimit) {
  int spawned = 0;
  const auto script = [&](const Edge&) {
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

/// A search of this many cycles. Its jobs have this many checkpoints, with a pause after each.
PathResult SearchWithJobsOf(int checkpoints, int cycles, std::chrono::microseconds pause) {
  const auto walk = std::make_shared<UncertainAction>(
      "walk", Interval{0.7, 1}, 0.85, Interval{4, 6}, [=](const Edge& edge) {
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

TEST(FindPath, JobsWithoutThreadsAreReproducible) { ExpectTheSameHoweverSlow(7, -1); }

TEST(FindPath, JobsThatOutliveTheirTurnsAreReproducible) { ExpectTheSameHoweverSlow(1200, 30); }

}  // namespace
}  // namespace possibility::graph
