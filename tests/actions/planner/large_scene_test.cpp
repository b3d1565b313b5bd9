// Large halls whose only way on is a door too narrow for the robot: the cost of a "no".

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <chrono>

#include "actions/planner/planner.h"
#include "tests/actions/drchubo1.h"

namespace possibility::actions {
namespace {

/// `side` m square, start and goal on either side of a door in the middle.
models::Scenario Hall(double side, double door) {
  models::Scenario scenario;
  scenario.name = scenario.file = "hall.yaml";
  scenario.robot_file = DrcHubo1().file;
  scenario.actions = {"walk", "crawl"};
  scenario.start = {"walk", -1.5, 0.3, 0, 0};
  scenario.goals = {{"walk", 1.5, 0.3, 0, 0}};
  models::Environment& environment = scenario.environment;
  const double half = side / 2, wall = (side - door) / 2;
  environment.bounds =
      Eigen::AlignedBox2d(Eigen::Vector2d(-half, -half), Eigen::Vector2d(half, half));
  const auto add = [&](const std::string& name, const Eigen::Vector3d& size, double x, double y) {
    models::Obstacle obstacle;
    obstacle.name = name;
    obstacle.shape = models::Shape::Box(size);
    obstacle.X_WO.translation() << x, y, size.z() / 2;
    environment.obstacles.push_back(obstacle);
  };
  add("floor", {side + 0.2, side + 0.2, 0.5}, 0, 0);
  environment.obstacles.front().X_WO.translation().z() = -0.25;
  environment.obstacles.front().is_ground = true;
  for (const int end : {-1, 1}) {
    add("end", {0.1, side + 0.2, 1.4}, end * (half + 0.05), 0);
    add("side", {side, 0.1, 1.4}, 0, end * (half + 0.05));
    add("door", {0.2, wall, 2.2}, 0, end * (door + wall) / 2);
  }
  return scenario;
}

double PeakMegabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1000;
}

TEST(LargeSceneTest, ANarrowDoorInAHallOfAHundredMetresIsExhausted) {
  PlanRequest request;
  request.library = DrcHubo1Library();
  request.time_limit = 1000;  // sanitizers are slow, and no test is about speed
  const PlanResult result = PlanTraversal(DrcHubo1(), Hall(100, 0.5), request);
  EXPECT_EQ(result.status, PlanStatus::kExhausted) << result.explanation;
  ASSERT_TRUE(result.plan.no && result.plan.no->passage);
  EXPECT_NE(result.explanation.find("0.50 m wide"), std::string::npos) << result.explanation;
}

/// Floods, search and their preparation keep to the time limit, whatever the bounds.
TEST(LargeSceneTest, TimeAndMemoryLimitsHoldInScenesOfKilometres) {
  for (const double side : {2000.0, 20000.0}) {
    PlanRequest request;
    request.library = DrcHubo1Library();
    request.time_limit = 4;
    const auto start = std::chrono::steady_clock::now();
    const PlanResult result = PlanTraversal(DrcHubo1(), Hall(side, 0.5), request);
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    EXPECT_EQ(result.status, PlanStatus::kTimeLimit) << result.explanation;
    EXPECT_LT(seconds, 2 * request.time_limit) << "the machine may be busy, but not so";
  }
  EXPECT_LT(PeakMegabytes(), 2000);
}

}  // namespace
}  // namespace possibility::actions
