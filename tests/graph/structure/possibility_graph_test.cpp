// PossibilityGraph, Reachability and ActionGraph, compared with brute force.
#include "graph/structure/possibility_graph.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <set>
#include <stdexcept>
#include <vector>

#include "graph/action/random.h"
#include "graph/structure/action_graph.h"
#include "tests/graph/stick_figure.h"

namespace possibility::graph {
namespace {

using test::MakePoint;

/// An action whose edges have durations from a hash of their ends. Some of the durations are zero.
class TimedAction : public test::BandAction {
 public:
  TimedAction() : BandAction("timed", {0, 1}, 0.5, {}) {}
  double ExpectedDuration(const Edge& edge) const override {
    return duration >= 0 ? std::floor(std::fmod(edge.from[0] * 37 + edge.to[0] * 91, 7)) : duration;
  }
  double duration = 0;
};

class RandomGraph : public ::testing::Test {
 protected:
  static constexpr int kVertices = 40;

  void Build(int num_goals) {
    std::vector<Point> goals;
    for (int g = 0; g < num_goals; ++g) {
      goals.push_back(MakePoint(1 + g, 0));
    }
    graph_ = std::make_unique<PossibilityGraph>(std::vector<std::shared_ptr<const Action>>{action_},
                                                &room_, MakePoint(0, 0), goals);
    for (int i = 1 + num_goals; i < kVertices; ++i) {
      ASSERT_EQ(graph_->VertexAt(MakePoint(i, 0)), i);
    }
  }

  int Random(int count) { return static_cast<int>(UniformIndex(count, &generator_)); }

  void AddRandomEdge() {
    const VertexId from = Random(kVertices);
    const VertexId to = Random(kVertices);
    graph_->Append(0, {{from, to, Random(3) == 0}});
  }

  std::vector<bool> BruteForceReached(const std::vector<VertexId>& roots, bool upstream) const {
    std::vector<bool> reached(kVertices, false);
    for (const VertexId root : roots) {
      reached[root] = true;
    }
    const DirectedGraph& topology = graph_->topology();
    for (bool changed = true; changed;) {
      changed = false;
      for (EdgeId edge = 0; edge < topology.num_edges(); ++edge) {
        const VertexId near = upstream ? topology.to(edge) : topology.from(edge);
        const VertexId far = upstream ? topology.from(edge) : topology.to(edge);
        if (!topology.removed(edge) && reached[near] && !reached[far]) {
          reached[far] = true;
          changed = true;
        }
      }
    }
    return reached;
  }

  RandomGenerator generator_{7};
  test::Room room_;
  std::shared_ptr<TimedAction> action_ = std::make_shared<TimedAction>();
  std::unique_ptr<PossibilityGraph> graph_;
};

TEST_F(RandomGraph, ReachabilityAgreesWithBruteForceAfterEveryChange) {
  for (int round = 0; round < 5; ++round) {
    Build(1 + round);
    int changes_of_reach = 0;
    std::vector<bool> before;
    for (int step = 0; step < 6000; ++step) {
      const int num_edges = graph_->topology().num_edges();
      const int what = Random(3);
      if (num_edges < 160 && (what == 0 || num_edges == 0)) {
        AddRandomEdge();
      } else if (what == 1) {
        graph_->Reinsert(Random(num_edges));
      } else {
        graph_->Remove(Random(num_edges));
      }
      const auto down = BruteForceReached({graph_->start()}, false);
      const auto up = BruteForceReached(graph_->goals(), true);
      for (VertexId v = 0; v < kVertices; ++v) {
        ASSERT_EQ(graph_->DownstreamFromStart(v), down[v]) << "step " << step << " vertex " << v;
        ASSERT_EQ(graph_->UpstreamFromGoal(v), up[v]) << "step " << step << " vertex " << v;
      }
      changes_of_reach += down != before;
      before = down;
    }
    EXPECT_GT(changes_of_reach, 100);
  }
}

TEST_F(RandomGraph, ShortestPathAgreesWithBellmanFord) {
  int connected = 0;
  int unconnected = 0;
  for (int round = 0; round < 200; ++round) {
    Build(2);
    const int num_edges = 20 + Random(80);
    for (int i = 0; i < num_edges; ++i) {
      AddRandomEdge();
    }
    for (int i = 0; i < num_edges / 4; ++i) {
      graph_->Remove(Random(graph_->topology().num_edges()));
    }
    std::vector<double> cost(kVertices, std::numeric_limits<double>::infinity());
    cost[0] = 0;
    for (int sweep = 0; sweep < kVertices; ++sweep) {
      for (EdgeId edge = 0; edge < graph_->topology().num_edges(); ++edge) {
        if (!graph_->topology().removed(edge)) {
          double& at_end = cost[graph_->topology().to(edge)];
          at_end = std::min(at_end, cost[graph_->topology().from(edge)] + graph_->duration(edge));
        }
      }
    }
    for (const VertexId goal : graph_->goals()) {
      const auto path = graph_->ShortestPath(0, goal);
      ASSERT_EQ(path.has_value(), std::isfinite(cost[goal]));
      ASSERT_EQ(path.has_value(), graph_->Connected(goal));
      if (!path) {
        ++unconnected;
        continue;
      }
      ++connected;
      double duration = 0;
      VertexId at = 0;
      for (const EdgeId edge : *path) {
        ASSERT_EQ(graph_->topology().from(edge), at);
        ASSERT_FALSE(graph_->topology().removed(edge));
        at = graph_->topology().to(edge);
        duration += graph_->duration(edge);
      }
      EXPECT_EQ(at, goal);
      EXPECT_DOUBLE_EQ(duration, cost[goal]);
    }
  }
  EXPECT_GT(connected, 50);
  EXPECT_GT(unconnected, 50);
}

TEST_F(RandomGraph, LeastDurationsAgreeWithBellmanFord) {
  int reached = 0;
  for (int round = 0; round < 100; ++round) {
    Build(2);
    const int num_edges = 20 + Random(80);
    for (int i = 0; i < num_edges; ++i) {
      AddRandomEdge();
    }
    const DirectedGraph& topology = graph_->topology();
    std::vector<bool> included(topology.num_edges());
    for (EdgeId edge = 0; edge < topology.num_edges(); ++edge) {
      included[edge] = Random(3) > 0;
      if (Random(5) == 0) {
        graph_->Remove(edge);
      }
    }
    const auto include = [&](EdgeId edge) { return included[edge]; };
    for (const bool upstream : {false, true}) {
      const std::vector<VertexId> roots =
          upstream ? graph_->goals() : std::vector<VertexId>{graph_->start()};
      std::vector<double> cost(kVertices, std::numeric_limits<double>::infinity());
      for (const VertexId root : roots) {
        cost[root] = 0;
      }
      for (int sweep = 0; sweep < kVertices; ++sweep) {
        for (EdgeId edge = 0; edge < topology.num_edges(); ++edge) {
          const VertexId near = upstream ? topology.to(edge) : topology.from(edge);
          const VertexId far = upstream ? topology.from(edge) : topology.to(edge);
          if (included[edge]) {
            cost[far] = std::min(cost[far], cost[near] + graph_->duration(edge));
          }
        }
      }
      const auto direction =
          upstream ? Reachability::Direction::kUpstream : Reachability::Direction::kDownstream;
      EXPECT_EQ(graph_->LeastDurations(roots, direction, include), cost);
      for (VertexId vertex = 0; !upstream && vertex < kVertices; ++vertex) {
        const bool finite = std::isfinite(cost[vertex]);
        const double limit = finite ? cost[vertex] : 1e9;
        EXPECT_EQ(graph_->LeadsWithin(graph_->start(), vertex, limit, include), finite);
        EXPECT_FALSE(finite && vertex != graph_->start() &&
                     graph_->LeadsWithin(graph_->start(), vertex, cost[vertex] - 0.5, include));
        reached += finite;
      }
    }
  }
  EXPECT_GT(reached, 500);
}

/// An action may know a duration better once it has confirmed the edge.
TEST_F(RandomGraph, AConfirmedEdgeTakesTheDurationOfTheActionThatConfirmedIt) {
  class Learning : public test::BandAction {
   public:
    explicit Learning(double duration) : BandAction("learning", {0, 1}, 0.5, {}), now(duration) {}
    double ExpectedDuration(const Edge&) const override { return now; }
    double now;
  };
  const auto finder = std::make_shared<Learning>(1), confirmer = std::make_shared<Learning>(2);
  PossibilityGraph graph({finder, confirmer}, &room_, MakePoint(0, 0), {MakePoint(1, 0)});
  graph.Append(0, {{0, 1, false}});
  finder->now = 5;
  EXPECT_EQ(graph.duration(0), 1);
  graph.RefreshDuration(0);
  EXPECT_EQ(graph.duration(0), 5);
  graph.SetPossible(0, 1);
  graph.RefreshDuration(0);
  EXPECT_EQ(graph.duration(0), 2);
  confirmer->now = -1;
  EXPECT_THROW(graph.RefreshDuration(0), std::invalid_argument);
}

TEST_F(RandomGraph, ExpectedDurationsMustBeFiniteAndNotNegative) {
  Build(1);
  for (const double bad : {-1.0, -std::numeric_limits<double>::infinity()}) {
    action_->duration = bad;
    EXPECT_THROW(graph_->Append(0, {{0, 1, false}}), std::invalid_argument);
  }
}

TEST_F(RandomGraph, ARemovedEdgeAddedAgainStaysRemoved) {
  Build(1);
  graph_->Append(0, {{0, 1, true}});
  ASSERT_EQ(graph_->topology().num_edges(), 2);
  EXPECT_EQ(graph_->opposite(0), 1);
  graph_->Remove(0);
  graph_->Append(0, {{0, 1, true}});
  EXPECT_EQ(graph_->topology().num_edges(), 2);
  EXPECT_FALSE(graph_->Connected(1));
}

TEST_F(RandomGraph, SubGraphsAreTheWeakComponentsOfTheRemainingEdges) {
  for (int round = 0; round < 30; ++round) {
    Build(1);
    ActionGraph action_graph(0, graph_.get());
    NewElements all;
    all.vertices.resize(kVertices);
    std::iota(all.vertices.begin(), all.vertices.end(), 0);
    action_graph.Append(all);
    for (int i = 0; i < 60; ++i) {
      const NewEdge edge = {Random(kVertices), Random(kVertices), round % 2 == 0};
      action_graph.Append({{}, {edge}});
      graph_->Append(0, {edge});
      if (i % 3 == 0) {
        const EdgeId removed = Random(graph_->topology().num_edges());
        graph_->Remove(removed);
        if (Random(4) == 0) {
          graph_->Reinsert(removed);
        }
      }
      std::vector<int> component(kVertices);
      std::iota(component.begin(), component.end(), 0);
      for (EdgeId e = 0; e < graph_->topology().num_edges(); ++e) {
        if (!graph_->topology().removed(e)) {
          const int kept = component[graph_->topology().from(e)];
          const int gone = component[graph_->topology().to(e)];
          std::replace(component.begin(), component.end(), gone, kept);
        }
      }
      std::set<int> members;
      for (const SubGraph& g : action_graph.SubGraphs()) {
        for (const VertexId v : g) {
          EXPECT_TRUE(members.insert(v).second);
          EXPECT_EQ(component[v], component[g[0]]);
        }
      }
      EXPECT_EQ(members.size(), kVertices);
      EXPECT_EQ(action_graph.SubGraphs().size(),
                std::set<int>(component.begin(), component.end()).size());
    }
  }
}

}  // namespace
}  // namespace possibility::graph
