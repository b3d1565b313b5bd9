// Algorithm 4 on the stick figure of Fig. 3, with a gap in its floor.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "graph/action/random.h"
#include "graph/search/find_path.h"
#include "graph/search/nonholonomic_exploration.h"
#include "tests/graph/path_checks.h"
#include "tests/graph/scripted_job.h"
#include "tests/graph/stick_figure.h"
#include "tests/graph/stick_jump.h"

namespace possibility::graph {
namespace {

using test::BandAction;
using test::Ending;
using test::ExpectPath;
using test::ExpectSameResult;
using test::Goal;
using test::Interval;
using test::JumpAction;
using test::MakePoint;
using test::ScriptedJob;
using test::SlowBandAction;
using test::Start;

using Actions = std::vector<std::shared_ptr<const Action>>;

const test::Room kHall;

constexpr double kReach = 1.6;      ///< what C_N of the jump assumes
constexpr double kTrueReach = 1.2;  ///< what its jobs confirm
constexpr int kWalk = 0;
constexpr int kCrawl = 1;
constexpr int kJump = 2;

double Length(const Edge& edge) { return std::abs(edge.to[0] - edge.from[0]); }

std::unique_ptr<ConfirmationJob> Truth(const Edge& edge) {
  const bool possible = Length(edge) <= kTrueReach;
  return std::make_unique<ScriptedJob>(possible ? Ending::kConfirm : Ending::kRefute, 3);
}

JumpAction::Script Always(Ending ending, std::chrono::microseconds per_step = {}) {
  return [=](const Edge&) { return std::make_unique<ScriptedJob>(ending, 3, per_step); };
}

/// Walking and crawling cannot cross the gap.
struct World {
  explicit World(Interval gap, JumpAction::Script script = Truth)
      : walk(std::make_shared<BandAction>("walk", Interval{0.7, 1}, 0.85,
                                          std::vector<Interval>{gap})),
        crawl(std::make_shared<BandAction>("crawl", Interval{0.2, 0.4}, 0.3,
                                           std::vector<Interval>{gap})),
        jump(std::make_shared<JumpAction>(walk, crawl, kReach, std::move(script))) {}
  Actions actions() const { return {walk, crawl, jump}; }

  std::shared_ptr<BandAction> walk;
  std::shared_ptr<BandAction> crawl;
  std::shared_ptr<JumpAction> jump;
};

constexpr Interval kGap = {4.6, 5.4};

FindPathSettings Settings(int threads, std::uint64_t seed) {
  return {.time_limit = 20,
          .seed = seed,
          .confirmation_threads = threads,
          .skip_growth = {{"jump", 0.9}}};
}

/// Whether a job confirmed the edge.
bool IsConfirmed(const PathResult& result, const Edge& edge) {
  return std::any_of(result.confirmations.begin(), result.confirmations.end(),
                     [&](const ConfirmationReport& report) {
                       return report.outcome == JobOutcome::kConfirmed && report.action == kJump &&
                              report.points.from == edge.from && report.points.to == edge.to;
                     });
}

void ExpectPlanWithJump(const PathResult& result, const Point& start, const Point& goal,
                        const World& world) {
  ExpectPath(result, start, goal);
  int jumps = 0;
  for (const PathEdge& edge : result.path) {
    if (edge.action == kJump) {
      ++jumps;
      EXPECT_TRUE(world.jump->CN(edge.points));
      EXPECT_LE(Length(edge.points), kTrueReach);
      EXPECT_TRUE(IsConfirmed(result, edge.points));
    } else {
      EXPECT_TRUE(world.actions()[edge.action]->CS(edge.points));
    }
  }
  EXPECT_GT(jumps, 0);
}

/// Every jump is connected, through jumps, to a vertex that is joined to others by walking or
/// crawling, or to an end of the route, because it was found next to such a vertex.
void ExpectJumpsLinedUp(const PathResult& result) {
  const std::vector<Point>& vertices = result.graph.vertices;
  std::vector<bool> joined(vertices.size(), false);
  joined[0] = joined[1] = true;
  std::vector<std::pair<int, int>> jumps;
  for (const GraphSnapshot::Edge& edge : result.graph.edges) {
    if (edge.action == kJump) {
      jumps.push_back({edge.from, edge.to});
    } else {
      joined[edge.from] = joined[edge.to] = true;
    }
  }
  const auto index_of = [&](const Point& point) {
    return std::find(vertices.begin(), vertices.end(), point) - vertices.begin();
  };
  for (const ConfirmationReport& report : result.confirmations) {
    jumps.push_back({index_of(report.points.from), index_of(report.points.to)});
  }
  for (std::size_t round = 0; round < jumps.size(); ++round) {
    for (const auto& [from, to] : jumps) {
      joined[from] = joined[to] = joined[from] || joined[to];
    }
  }
  for (const auto& jump : jumps) {
    EXPECT_TRUE(joined[jump.first]);
  }
}

class Jump : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(StickFigure, Jump, ::testing::Values(0, 2));

TEST_P(Jump, CrossesTheGapWithEverySeed) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    const World world(kGap);
    const bool there = seed % 2 == 1;
    const Point& start = there ? Start() : Goal();
    const Point& goal = there ? Goal() : Start();
    const PathResult result =
        FindPath(start, {goal}, world.actions(), kHall, Settings(GetParam(), seed));
    ExpectPlanWithJump(result, start, goal, world);
    ExpectJumpsLinedUp(result);
  }
}

TEST_P(Jump, NeverCrossesAGapThatIsTooWide) {
  // A gap wider than C_N assumes, and one wider than the jobs confirm.
  for (const Interval gap : {Interval{4, 5.7}, Interval{4, 5.3}}) {
    std::int64_t refuted = 0;
    for (std::uint64_t seed = 1; seed <= 50; ++seed) {
      const World world(gap);
      FindPathSettings settings = Settings(GetParam(), seed);
      settings.max_cycles = 100;
      const PathResult result = FindPath(Start(), {Goal()}, world.actions(), kHall, settings);
      EXPECT_EQ(result.status, PathStatus::kTimeLimit);
      EXPECT_EQ(result.statistics.cycles, 100);
      EXPECT_TRUE(result.path.empty());
      refuted += result.counters.at("jobs refuted");
      for (const ConfirmationReport& report : result.confirmations) {
        const bool too_far = Length(report.points) > kTrueReach;
        EXPECT_EQ(report.outcome, too_far ? JobOutcome::kRefuted : JobOutcome::kConfirmed);
      }
    }
    EXPECT_EQ(refuted > 0, gap.high < 5.5);
  }
}

/// The gap can also be crawled through, which takes longer.
Actions WithSlowDetour(const JumpAction::Script& script) {
  const World world(kGap);
  const auto crawl =
      std::make_shared<SlowBandAction>("crawl", Interval{0.2, 0.4}, 0.3, std::vector<Interval>{});
  return {world.walk, crawl, std::make_shared<JumpAction>(world.walk, crawl, kReach, script)};
}

TEST_P(Jump, WhileJobsAreUndecidedASlowerRouteWithoutJumpsIsReturned) {
  int jumps_wanted = 0;
  const std::uint64_t seeds = GetParam() == 0 ? 2 : 10;  // a turn without workers takes 3 s
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    FindPathSettings settings = Settings(GetParam(), seed);
    settings.skip_growth.clear();
    const auto a_minute = [](const Edge&) {
      return std::make_unique<ScriptedJob>(Ending::kConfirm, 60000, std::chrono::milliseconds(1));
    };
    const PathResult result =
        FindPath(Start(), {Goal()}, WithSlowDetour(a_minute), kHall, settings);
    ASSERT_EQ(result.status, PathStatus::kFound);
    EXPECT_LT(result.seconds, 15);
    for (const PathEdge& edge : result.path) {
      EXPECT_NE(edge.action, kJump);
    }
    jumps_wanted += result.counters.at("jobs spawned") > 0;
    EXPECT_EQ(result.counters.at("jobs cancelled"), result.counters.at("jobs spawned"));
  }
  EXPECT_GT(jumps_wanted, 0);
}

TEST_P(Jump, FaultyJobsLeaveARouteWithoutJumps) {
  for (const Ending ending :
       {Ending::kRefute, Ending::kThrow, Ending::kGiveUp, Ending::kNonsense, Ending::kNever}) {
    std::int64_t spawned = 0;
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      FindPathSettings settings = Settings(GetParam(), seed);
      settings.skip_growth.clear();
      settings.confirmation_job_limit = 0.02;
      const PathResult result =
          FindPath(Start(), {Goal()}, WithSlowDetour(Always(ending)), kHall, settings);
      ASSERT_EQ(result.status, PathStatus::kFound);
      for (const PathEdge& edge : result.path) {
        EXPECT_NE(edge.action, kJump);
      }
      spawned += result.counters.at("jobs spawned");
      EXPECT_EQ(result.counters.at("jobs confirmed"), 0);
      EXPECT_EQ(static_cast<int>(result.confirmations.size()), result.counters.at("jobs spawned"));
    }
    EXPECT_GT(spawned, 0);
  }
}

TEST_P(Jump, EndlessJobsDoNotHoldUpTheTimeLimit) {
  double least = std::numeric_limits<double>::infinity();  // the machine may be busy
  for (int attempt = 0; attempt < 5 && least >= 0.05; ++attempt) {
    const World world(kGap, Always(Ending::kNever));
    FindPathSettings settings = Settings(GetParam(), 1);
    settings.time_limit = 0.3;
    const PathResult result = FindPath(Start(), {Goal()}, world.actions(), kHall, settings);
    EXPECT_EQ(result.status, PathStatus::kTimeLimit);
    EXPECT_GT(result.counters.at("jobs cancelled"), 0);
    least = std::min(least, result.seconds - settings.time_limit);
  }
  EXPECT_LT(least, 0.05);
}

TEST(StickFigureJump, TheSameSeedGivesTheSameResult) {
  const auto run = [](std::uint64_t seed) {
    return FindPath(Start(), {Goal()}, World(kGap).actions(), kHall, Settings(0, seed));
  };
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    ExpectSameResult(run(seed), run(seed));
  }
}

TEST(StickFigureJump, GrowthIsSkippedWithTheGivenProbability) {
  for (const double skip : {0.0, 0.5, 0.9, 1.0}) {
    const World world({4, 6});
    FindPathSettings settings{.max_cycles = 400, .skip_growth = {{"jump", skip}}};
    FindPath(Start(), {Goal()}, world.actions(), kHall, settings);
    const double expected = 400 * (1 - skip);
    const double five_deviations = 5 * std::sqrt(expected * skip);
    EXPECT_NEAR(static_cast<double>(world.jump->targets.size()), expected, five_deviations);
  }
}

/// One exploration of the jump on a graph of a few vertices.
class Growth : public ::testing::Test {
 protected:
  Growth() : world_({4.6, 5.4}) {}

  void Build(const Point& start, const Point& goal) {
    actions_ = world_.actions();
    master_ = std::make_unique<PossibilityGraph>(actions_, &kHall, start, std::vector<Point>{goal});
    exploration_ = MakeActionExploration(*world_.jump, kJump,
                                         {.actions = &actions_,
                                          .space = &kHall,
                                          .settings = &settings_,
                                          .master = master_.get(),
                                          .generator = &generator_,
                                          .deadline = &deadline_,
                                          .counters = &counters_});
    exploration_->AddInitialVertex(master_->start());
    exploration_->AddInitialVertex(master_->goals()[0]);
  }

  Edge Points(const NewEdge& edge) const {
    return {master_->point(edge.from), master_->point(edge.to)};
  }
  void ExpectEdge(const NewEdge& edge, const Point& from, const Point& to) const {
    EXPECT_LT((Points(edge).from - from).norm(), 1e-12);
    EXPECT_LT((Points(edge).to - to).norm(), 1e-12);
  }

  World world_;
  Actions actions_;
  Counters counters_;
  FindPathSettings settings_{.max_transitions_per_cycle = 100};
  RandomGenerator generator_{1};
  Deadline deadline_{std::numeric_limits<double>::infinity()};
  std::unique_ptr<PossibilityGraph> master_;
  std::unique_ptr<ActionExploration> exploration_;
};

TEST_F(Growth, FromTheStartALaunchIsLinedUpByWalking) {
  Build(MakePoint(4.4, 0.95), MakePoint(9, 0.5));
  const NewElements found = exploration_->GrowTowards(MakePoint(5.7, 0.1));
  ASSERT_EQ(found.edges.size(), 1);
  EXPECT_FALSE(found.edges[0].reversible);
  ExpectEdge(found.edges[0], MakePoint(4.4, 0.85), MakePoint(5.7, 0.3));
  ASSERT_EQ(found.line_ups.size(), 1);
  EXPECT_EQ(found.line_ups[0].action, kWalk);
  EXPECT_TRUE(found.line_ups[0].edge.reversible);
  ExpectEdge(found.line_ups[0].edge, MakePoint(4.4, 0.95), MakePoint(4.4, 0.85));
  EXPECT_EQ(found.offered, (std::vector<VertexId>{found.edges[0].from, found.edges[0].to}));
  EXPECT_EQ(found.vertices, found.offered);
}

TEST_F(Growth, TowardsTheGoalALandingIsContinuedByCrawling) {
  Build(MakePoint(0.5, 0.5), MakePoint(5.6, 0.4));
  const NewElements found = exploration_->GrowTowards(MakePoint(1, 0.1));
  ASSERT_EQ(found.edges.size(), 1);
  ExpectEdge(found.edges[0], MakePoint(5.6 - kReach, 0.85), MakePoint(5.6, 0.3));
  ASSERT_EQ(found.line_ups.size(), 1);
  EXPECT_EQ(found.line_ups[0].action, kCrawl);
  ExpectEdge(found.line_ups[0].edge, MakePoint(5.6, 0.3), MakePoint(5.6, 0.4));
}

TEST_F(Growth, AVertexThatIsLinedUpNeedsNoLineUpEdge) {
  Build(MakePoint(4.4, 0.85), MakePoint(9, 0.5));
  const NewElements found = exploration_->GrowTowards(MakePoint(5.7, 0.1));
  EXPECT_EQ(found.edges.size(), 1);
  EXPECT_TRUE(found.line_ups.empty());
  EXPECT_EQ(found.vertices.size(), 1);
}

TEST_F(Growth, RefutedLineUpsAndJumpsAreNotTriedAgain) {
  Build(MakePoint(4.4, 0.95), MakePoint(9, 0.5));
  const NewElements once = exploration_->GrowTowards(MakePoint(5.7, 0.1));
  master_->Append(kJump, once.edges);
  master_->Append(kWalk, {once.line_ups[0].edge});
  EXPECT_EQ(exploration_->GrowTowards(MakePoint(5.7, 0.1)).edges.size(), 1);
  const EdgeId line_up =
      *master_->FindEdge(kWalk, once.line_ups[0].edge.from, once.line_ups[0].edge.to);
  master_->Remove(line_up);
  // The launch point itself is part of the graph by now. From there the jump is still possible.
  EXPECT_TRUE(exploration_->GrowTowards(MakePoint(5.7, 0.1)).line_ups.empty());
  EXPECT_GT(counters_.at("jump: growth not lined up"), 0);
  master_->Remove(*master_->FindEdge(kJump, once.edges[0].from, once.edges[0].to));
  EXPECT_TRUE(exploration_->GrowTowards(MakePoint(5.7, 0.1)).edges.empty());
  EXPECT_GT(counters_.at("jump: growth stopped at removed edge"), 0);
}

TEST_F(Growth, OfConnectedVerticesOnlyTheClosestLaunches) {
  for (const bool joined : {true, false}) {
    Build(MakePoint(3, 0.85), MakePoint(9, 0.5));
    std::vector<VertexId> line = {master_->start()};
    for (int i = 1; i <= 5; ++i) {
      line.push_back(master_->VertexAt(MakePoint(3 + 0.3 * i, 0.85)));
      if (joined) {
        master_->Append(kWalk, {{line[i - 1], line[i], false}});
      }
      exploration_->TakeOver({.vertices = {line[i]}});
    }
    exploration_->PerformTransitions();
    const NewElements found = exploration_->GrowTowards(MakePoint(5.9, 0.3));
    EXPECT_EQ(found.edges.size(), joined ? 1 : 3);  // from those that reach the other side
    ASSERT_FALSE(found.edges.empty());
    EXPECT_EQ(found.edges[0].from, line.back());
  }
}

}  // namespace
}  // namespace possibility::graph
