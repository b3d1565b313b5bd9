#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

#include "tests/graph/path_checks.h"
#include "tests/graph/search/searches.h"

namespace possibility::graph {
namespace {

using test::Actions;
using test::Always;
using test::Ending;
using test::ExpectSamePath;
using test::ExpectValidPath;
using test::Goal;
using test::Interval;
using test::kRoom;
using test::LeastOvershoot;
using test::MakeCrawl;
using test::ScriptedJob;
using test::Start;
using test::UncertainAction;

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

/// A walk that is uncertain in one place. Jobs decide in about 30 ms, or never.
std::shared_ptr<UncertainAction> WalkWithSlowJobs(Ending ending) {
  return std::make_shared<UncertainAction>(
      "walk", Interval{0.7, 1}, 0.85, Interval{4.9, 5.1}, [ending](const Edge&) {
        return std::make_unique<ScriptedJob>(ending, 100, std::chrono::microseconds(200));
      });
}

/// A search and how often it asked its oracle, which answers "exhausted".
std::pair<PathResult, int> SearchWithOracle(Ending ending, int threads) {
  int asked = 0;
  FindPathSettings settings{
      .time_limit = 10, .confirmation_threads = threads, .ask_oracle_after = 200};
  settings.oracle = [&asked] {
    ++asked;
    return RouteOracleAnswer::kExhausted;
  };
  PathResult result = FindPath(Start(), {Goal()}, {WalkWithSlowJobs(ending)}, kRoom, settings);
  return {std::move(result), asked};
}

TEST_P(WithJobs, TheOracleIsNotAskedBeforeAQuickJobConfirms) {
  const auto [result, asked] = SearchWithOracle(Ending::kConfirm, GetParam());
  EXPECT_EQ(result.status, PathStatus::kFound);
  EXPECT_EQ(asked, 0);
}

TEST_P(WithJobs, TheOracleIsAskedBesideJobsThatNeverEnd) {
  const auto [result, asked] = SearchWithOracle(Ending::kNever, GetParam());
  EXPECT_EQ(result.status, PathStatus::kExhausted);
  EXPECT_EQ(asked, 1);
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

TEST(FindPath, JobsWithoutThreadsAreReproducible) { ExpectTheSameHoweverSlow(7, -1); }

TEST(FindPath, JobsThatOutliveTheirTurnsAreReproducible) { ExpectTheSameHoweverSlow(1200, 30); }

}  // namespace
}  // namespace possibility::graph
