#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "graph/search/explorer.h"
#include "graph/search/random_explorer.h"
#include "tests/graph/search/searches.h"

namespace possibility::graph {
namespace {

using test::Actions;
using test::Always;
using test::Ending;
using test::ExpectValidPath;
using test::Goal;
using test::Interval;
using test::kRoom;
using test::MakeCrawl;
using test::MakePoint;
using test::MakeWalk;
using test::Start;
using test::UncertainAction;
using test::WayUnderTheBar;

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

/// Also if nobody has anything left to explore by then.
TEST(Explorers, ARouteThatTheLastJobCompletesIsFound) {
  const auto leap = std::make_shared<UncertainAction>("leap", Interval{0.7, 1.0}, 0.85,
                                                      Interval{4, 6}, Always(Ending::kConfirm, 2));
  const Actions actions = {leap};
  for (const int threads : {0, 2}) {
    FindPathSettings settings{.time_limit = 10, .confirmation_threads = threads};
    settings.explorers = First([] { return Findings{Outlook::kOver, {{0, {Start(), Goal()}}}}; });
    settings.explorers.pop_back();
    const PathResult result = FindPath(Start(), {Goal()}, actions, kRoom, settings);
    EXPECT_EQ(result.status, PathStatus::kFound) << threads << " threads";
    EXPECT_EQ(result.path.size(), 1);
  }
}

}  // namespace
}  // namespace possibility::graph
