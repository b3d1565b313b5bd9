#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "graph/search/find_path.h"
#include "tests/graph/path_checks.h"
#include "tests/graph/scripted_job.h"
#include "tests/graph/stick_figure.h"

namespace possibility::graph::test {

using Actions = std::vector<std::shared_ptr<const Action>>;

inline const Room kRoom;

inline void ExpectValidPath(const PathResult& result, const Point& start,
                            const std::vector<Point>& goals, const Actions& actions) {
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

inline UncertainAction::Script Always(Ending ending, int steps) {
  return [=](const Edge&) { return std::make_unique<ScriptedJob>(ending, steps); };
}

/// Over the rubble, down, under the bar, and up again.
inline std::vector<PathEdge> WayUnderTheBar() {
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

/// The least overshoot of a few searches, s, since the machine may be busy with something else.
inline double LeastOvershoot(const Actions& actions, const FindPathSettings& settings) {
  double least = std::numeric_limits<double>::infinity();
  for (int attempt = 0; attempt < 10 && least >= 0.05; ++attempt) {
    const PathResult result = FindPath(Start(), {Goal()}, actions, kRoom, settings);
    EXPECT_EQ(result.status, PathStatus::kTimeLimit);
    EXPECT_GE(result.seconds, settings.time_limit);
    least = std::min(least, result.seconds - settings.time_limit);
  }
  return least;
}

}  // namespace possibility::graph::test
