#include "actions/flood/least_way.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "actions/conditions/exploration_pose.h"
#include "models/world/ground_map.h"
#include "tests/actions/drchubo1.h"

namespace possibility::actions {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// A floor of 6 m x 6 m, and walls too high to cross.
class LeastWayTest : public ::testing::Test {
 protected:
  LeastWayTest() {
    environment_.bounds = Eigen::AlignedBox2d(Vector2d(-3, -3), Vector2d(3, 3));
    Add({-4, -4, -0.5}, {4, 4, 0}, true);
  }

  void Add(const Vector3d& low, const Vector3d& high, bool is_ground) {
    models::Obstacle obstacle;
    obstacle.shape = models::Shape::Box(high - low);
    obstacle.X_WO.translation() = (low + high) / 2;
    obstacle.is_ground = is_ground;
    environment_.obstacles.push_back(obstacle);
  }

  void AddWall(double x0, double y0, double x1, double y1) { Add({x0, y0, 0}, {x1, y1, 3}, false); }

  std::optional<double> Between(const Vector2d& start, const Vector2d& goal) const {
    const models::GroundMap ground(environment_);
    const World world{&environment_, &ground};
    return LeastWay(DrcHubo1Locomotion(), world, {0, {start.x(), start.y(), 0}, 0},
                    {{0, {goal.x(), goal.y(), 0}, 0}}, 0.1, {});
  }

  models::Environment environment_;
};

TEST_F(LeastWayTest, IsTheStraightDistanceWhereNothingIsInTheWay) {
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> unit(-2.5, 2.5);
  for (int i = 0; i < 20; ++i) {
    const Vector2d start(unit(generator), unit(generator)), goal(unit(generator), unit(generator));
    const std::optional<double> way = Between(start, goal);
    ASSERT_TRUE(way);
    EXPECT_NEAR(*way, (goal - start).norm(), 1e-9);
  }
}

TEST_F(LeastWayTest, LeadsAroundAWallAndNeverTooFar) {
  AddWall(-0.2, -4, 0.2, 1.5);
  std::mt19937 generator(4);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 20; ++i) {
    const Vector2d start(-0.7 - 2 * unit(generator), -2.5 + 3 * unit(generator));
    const Vector2d goal(0.7 + 2 * unit(generator), -2.5 + 3 * unit(generator));
    // Around both upper corners: a point, without a body, could go that way.
    const Vector2d left(-0.2, 1.5), right(0.2, 1.5);
    const double least = (left - start).norm() + (right - left).norm() + (goal - right).norm();
    const std::optional<double> way = Between(start, goal);
    ASSERT_TRUE(way);
    EXPECT_LE(*way, least + 0.25) << "the pelvis has a radius";
    EXPECT_GE(*way, 0.85 * least - 0.5) << "factor of the grid, and cells";
    EXPECT_GT(*way, (goal - start).norm());
  }
}

TEST_F(LeastWayTest, ThereIsNoneThroughAWallFromBoundToBound) {
  AddWall(-0.4, -4, 0.4, 4);
  EXPECT_FALSE(Between({-2, 0}, {2, 0}));
}

TEST_F(LeastWayTest, IsBelowTheLengthOfWaysThatTheRobotCanGo) {
  std::mt19937 generator(5);
  std::uniform_real_distribution<double> unit(-2.2, 2.2);
  for (int i = 0; i < 14; ++i) {
    const double x = unit(generator), y = unit(generator);
    AddWall(x - 0.15, y - 0.15, x + 0.15, y + 0.15);
  }
  const models::GroundMap ground(environment_);
  const World world{&environment_, &ground};
  const auto space = std::make_shared<PelvisPoseSpace>(environment_.bounds, ground.levels(), 0.137);
  const QuasiStaticAction walk(DrcHubo1Locomotion(), 0, world, space, 0.25);
  // Random walks that meet C_S.
  int compared = 0;
  for (int trial = 0; trial < 12; ++trial) {
    GroundedStance here{0, {unit(generator), unit(generator), unit(generator)}, 0};
    if (!walk.CS(here, here)) continue;
    const GroundedStance start = here;
    double length = 0;
    for (int step = 0; step < 200; ++step) {
      GroundedStance next = here;
      next.pose = here.pose * PlanarPose{0.3 * unit(generator), 0.1 * unit(generator), 0};
      next.pose.yaw += 0.2 * unit(generator);
      if (!walk.CS(here, next)) continue;
      length += (next.pose.position() - here.pose.position()).norm();
      here = next;
      if (step % 20 != 0) continue;
      const auto way = LeastWay(DrcHubo1Locomotion(), world, start, {here}, 0.1, {});
      ASSERT_TRUE(way);
      // Turning moves the pelvis, which is not quite in the stance's axis.
      EXPECT_LE(*way, length + 0.05);
      ++compared;
    }
  }
  EXPECT_GT(compared, 5);
}

}  // namespace
}  // namespace possibility::actions
