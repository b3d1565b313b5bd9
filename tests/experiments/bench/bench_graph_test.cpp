#include "experiments/bench/bench_graph.h"

#include <gtest/gtest.h>

#include <map>
#include <set>
#include <stdexcept>
#include <string>

#include "experiments/bench/obstacle_field.h"
#include "experiments/bench/single_gait_search.h"
#include "models/input/input_error.h"
#include "models/robot/robot_yaml.h"
#include "models/world/ground_map.h"
#ifdef POSSIBILITY_WITH_OMPL
#include "experiments/bench/ompl_peers.h"
#endif

namespace possibility::experiments {
namespace {

using actions::PlanarPose;
using actions::PlannerPreset;

const std::string kSource = POSSIBILITY_SOURCE_DIR;

const models::RobotModel& Robot() {
  static const models::RobotModel robot =
      models::LoadRobotModel(kSource + "/models/drchubo1/drchubo1.yaml");
  return robot;
}

models::Scenario ThreeRoutes() {
  return models::LoadScenario(kSource + "/experiments/scenarios/three_routes_a.yaml");
}

/// Expects a way from start to goal, with every stance and every part between them valid.
void ExpectWay(const SingleGaitSearch& search, const FoundPath& path) {
  ASSERT_TRUE(path.found);
  ASSERT_GE(path.poses.size(), 2U);
  const auto expect_same = [](const PlanarPose& a, const PlanarPose& b) {
    EXPECT_NEAR(a.x, b.x, 1e-9);
    EXPECT_NEAR(a.y, b.y, 1e-9);
    EXPECT_NEAR(actions::WrapAngle(a.yaw - b.yaw), 0, 1e-9);
  };
  expect_same(path.poses.front(), search.start());
  expect_same(path.poses.back(), search.goal());
  for (size_t i = 1; i < path.poses.size(); ++i) {
    EXPECT_TRUE(search.IsValid(path.poses[i]));
    EXPECT_TRUE(search.IsValid(path.poses[i - 1], path.poses[i])) << "edge " << i;
  }
}

void ExpectSameObstacles(const models::Environment& a, const models::Environment& b) {
  ASSERT_EQ(a.obstacles.size(), b.obstacles.size());
  for (size_t i = 0; i < a.obstacles.size(); ++i) {
    EXPECT_EQ(a.obstacles[i].name, b.obstacles[i].name);
    EXPECT_EQ(a.obstacles[i].shape.type, b.obstacles[i].shape.type);
    EXPECT_EQ(a.obstacles[i].shape.size, b.obstacles[i].shape.size);
    EXPECT_EQ(a.obstacles[i].shape.radius, b.obstacles[i].shape.radius);
    EXPECT_EQ(a.obstacles[i].X_WO.matrix(), b.obstacles[i].X_WO.matrix());
  }
}

TEST(ObstacleFieldTest, TheSameArgumentsGiveTheSameField) {
  ExpectSameObstacles(ObstacleField(500, 3).environment, ObstacleField(500, 3).environment);
  const models::Scenario other = ObstacleField(500, 4);
  EXPECT_NE(ObstacleField(500, 3).environment.obstacles.back().X_WO.matrix(),
            other.environment.obstacles.back().X_WO.matrix());
}

TEST(ObstacleFieldTest, HasTheRequestedObstaclesAtTheSameDensity) {
  for (const int count : {0, 1, 16, 17, 1000, 10000}) {
    const models::Scenario field = ObstacleField(count, 1);
    EXPECT_EQ(field.environment.obstacles.size(), static_cast<size_t>(count) + 1);
    EXPECT_EQ(models::GroundMap(field.environment).levels(), std::vector<double>{0});
    std::set<std::string> names;
    for (const models::Obstacle& obstacle : field.environment.obstacles) {
      names.insert(obstacle.name);
    }
    EXPECT_EQ(names.size(), field.environment.obstacles.size());
    if (count < 1000) continue;
    EXPECT_NEAR(count / field.environment.bounds.volume(), 16.0 / 6, 0.05);
  }
  EXPECT_THROW(ObstacleField(-1, 1), std::invalid_argument);
}

TEST(ObstacleFieldTest, SomeObstaclesBlockWalkingAloneAndSomeBothGaits) {
  int low = 0;
  int tall = 0;
  int overhead = 0;
  for (const models::Obstacle& obstacle : ObstacleField(2000, 1).environment.obstacles) {
    if (obstacle.is_ground) continue;
    const Eigen::AlignedBox3d bounds = obstacle.shape.Bounds(obstacle.X_WO);
    if (bounds.min().z() > 0.8) {
      ++overhead;
      EXPECT_LT(bounds.max().z(), 1.25);  // walking is 1.25 m tall, crawling 0.8 m
    } else {
      EXPECT_NEAR(bounds.min().z(), 0, 1e-12);
      ++(bounds.max().z() > 0.8 ? tall : low);
    }
  }
  EXPECT_GT(low, 400);
  EXPECT_GT(tall, 300);
  EXPECT_GT(overhead, 300);
}

TEST(SingleGaitSearchTest, EachGaitFindsAWayThroughEachScene) {
  for (const std::string gait : {"walk", "crawl"}) {
    for (const models::Scenario& scene : {ThreeRoutes(), ObstacleField(1000, 1)}) {
      const SingleGaitSearch search(Robot(), gait, scene);
      for (const PlannerPreset preset : {PlannerPreset::kDefault, PlannerPreset::kPaper}) {
        const FoundPath path = search.Find(preset, 1, 60);
        ExpectWay(search, path);
        EXPECT_GE(LengthOf(path.poses),
                  (search.goal().position() - search.start().position()).norm() - 1e-9);
      }
    }
  }
}

TEST(SingleGaitSearchTest, RefusesUnknownGaitsAndStartsInCollision) {
  EXPECT_THROW(SingleGaitSearch(Robot(), "hop", ThreeRoutes()), InputError);
  EXPECT_THROW(SingleGaitSearch(Robot(), "jump", ThreeRoutes()), InputError);
  models::Scenario inside = ThreeRoutes();
  inside.start.x = 5;
  inside.start.y = 1.4;
  EXPECT_THROW(SingleGaitSearch(Robot(), "walk", inside), InputError);
}

TEST(BenchGraphTest, ReportHasARatioPerGait) {
  GraphBenchSettings settings;
  settings.scenarios = kSource + "/experiments/scenarios";
  settings.seeds = 1;
  settings.obstacles = 200;
  settings.time_limit = 1;
  settings.preset_seeds = 0;
  int seen = 0;
  const BenchmarkReport report = BenchGraph(Robot(), settings, [&](int done, int of) {
    EXPECT_EQ(done, ++seen);
    EXPECT_EQ(of, 4);
  });
  EXPECT_EQ(seen, 4);
  std::map<std::string, double> ratios;
  for (const BenchmarkRatio& ratio : report.ratios) ratios[ratio.name] = ratio.value;
  std::map<std::string, double> rows;
  for (const BenchmarkRow& row : report.rows) rows[row.name] = row.microseconds;
  for (const char* scene : {"three_routes_a", "field_of_200"}) {
    for (const std::string gait : {"walk", "crawl"}) {
      EXPECT_GT(rows.at(scene + (", " + gait) + ": possibility graph (straight, lattice, random)"),
                0);
      EXPECT_GT(rows.at(scene + (", " + gait) + ": possibility graph (random)"), 0);
    }
  }
#ifdef POSSIBILITY_WITH_OMPL
  for (const std::string gait : {"walk", "crawl"}) {
    // The smaller lead of the two scenes over the best of all peers.
    double least = 1e300;
    for (const std::string scene : {"three_routes_a", "field_of_200"}) {
      const std::string begin = scene + ", " + gait + ": ";
      double best = 1e300;
      for (const auto& [name, microseconds] : rows) {
        if (name.starts_with(begin + "OMPL ")) best = std::min(best, microseconds);
      }
      least =
          std::min(least, best / rows.at(begin + "possibility graph (straight, lattice, random)"));
    }
    EXPECT_DOUBLE_EQ(ratios.at("first_solution_vs_ompl_" + gait), least);
  }
  EXPECT_EQ(ratios.size(), 2U);
#else
  EXPECT_TRUE(ratios.empty());
#endif
}

#ifdef POSSIBILITY_WITH_OMPL
TEST(OmplPeersTest, WaysOfEachPlannerPassOurOwnChecks) {
  int found = 0;
  for (const std::string gait : {"walk", "crawl"}) {
    const SingleGaitSearch search(Robot(), gait, ThreeRoutes());
    const PlanarQuery query = QueryOf(search);
    for (const std::string& planner : OmplPlanners()) {
      const PeerSearch answer = SolveWithOmpl(planner, query, 1, 5);
      if (!answer.found) continue;
      ++found;
      SCOPED_TRACE(planner + ", " + gait);
      EXPECT_GT(answer.seconds, 0);
      ExpectWay(search, PathOf(answer));
    }
  }
  EXPECT_GE(found, 18) << "of 20";
}

TEST(OmplPeersTest, OneSeedGivesOneAnswer) {
  const SingleGaitSearch search(Robot(), "walk", ThreeRoutes());
  const PlanarQuery query = QueryOf(search);
  const auto path = [&](std::uint32_t seed) {
    return PathOf(SolveWithOmpl("RRTConnect", query, seed, 5)).poses;
  };
  const std::vector<PlanarPose> first = path(7);
  const std::vector<PlanarPose> other = path(8);
  const std::vector<PlanarPose> again = path(7);
  ASSERT_EQ(first.size(), again.size());
  for (size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].x, again[i].x);
    EXPECT_EQ(first[i].y, again[i].y);
    EXPECT_EQ(first[i].yaw, again[i].yaw);
  }
  EXPECT_NE(LengthOf(first), LengthOf(other));
}

TEST(OmplPeersTest, TheTimeLimitIsKeptAndUnknownPlannersAreRefused) {
  models::Scenario closed = ThreeRoutes();
  closed.environment.obstacles.push_back(
      {"wall", models::Shape::Box({0.2, 8, 2}), PlanarPose{5, 0, 0}.At(1), false});
  const SingleGaitSearch search(Robot(), "walk", closed);
  const PlanarQuery query = QueryOf(search);
  const PeerSearch answer = SolveWithOmpl("RRTConnect", query, 1, 0.1);
  EXPECT_FALSE(answer.found);
  EXPECT_TRUE(answer.path.empty());
  EXPECT_GE(answer.seconds, 0.1);
  EXPECT_THROW(SolveWithOmpl("RRTCollect", query, 1, 1), std::invalid_argument);
}
#endif

}  // namespace
}  // namespace possibility::experiments
