// Rooms so small that C_S only just lets the robot move in them, by class of stride: what it lets
// through must still verify.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "actions/verification_report.h"
#include "tests/actions/drchubo1.h"
#include "tests/actions/leg_scene.h"
#include "tests/actions/quadruped.h"

namespace possibility::actions {
namespace {

/// Walls around the origin, each with the direction that it stands in and its distance.
class Room {
 public:
  explicit Room(std::mt19937* generator) {
    std::uniform_real_distribution<double> unit(0, 1);
    for (double direction = unit(*generator); direction < 2 * M_PI;
         direction += 0.5 + 1.2 * unit(*generator)) {
      walls_.push_back({direction, kWide, 0.3 + unit(*generator)});
    }
  }

  int num_walls() const { return static_cast<int>(walls_.size()); }
  double& distance(int wall) { return walls_[wall].distance; }

  models::Environment Environment() const {
    models::Environment environment;
    environment.bounds = Eigen::AlignedBox2d(Eigen::Vector2d(-3, -3), Eigen::Vector2d(3, 3));
    models::Obstacle floor;
    floor.name = "floor";
    floor.shape = models::Shape::Box({8, 8, 0.2});
    floor.X_WO.translation().z() = -0.1;
    floor.is_ground = true;
    environment.obstacles = {floor};
    for (const Wall& wall : walls_) {
      models::Obstacle obstacle;
      obstacle.name = "wall";
      obstacle.shape = models::Shape::Box({0.1, 6, wall.height});
      obstacle.X_WO = (PlanarPose{0, 0, wall.direction} * PlanarPose{wall.distance + 0.05, 0, 0})
                          .At(wall.height / 2);
      environment.obstacles.push_back(obstacle);
    }
    return environment;
  }

  static constexpr double kWide = 2.5;

 private:
  struct Wall {
    double direction;
    double distance;
    double height;
  };
  std::vector<Wall> walls_;
};

bool IsSufficient(const LocomotionModel& model, const Room& room, const RouteLeg& leg) {
  return LegScene(model, room.Environment()).action(leg.gait).CS(LegEdge(model, leg));
}

/// Moves every wall in turn as close as C_S allows, to a millimetre.
void Shrink(const LocomotionModel& model, const RouteLeg& leg, Room* room) {
  for (int wall = 0; wall < room->num_walls(); ++wall) {
    double free = Room::kWide, blocked = 0;
    while (free - blocked > 1e-3) {
      const double middle = (free + blocked) / 2;
      room->distance(wall) = middle;
      (IsSufficient(model, *room, leg) ? free : blocked) = middle;
    }
    room->distance(wall) = free;
  }
}

RouteLeg RandomLeg(StrideClass strides, int gait, std::mt19937* generator) {
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto random = [&] { return unit(*generator); };
  PlanarPose displacement{0.4 * random(), 0.2 * random(), 0.6 * random()};
  if (!Includes(strides, {1, 0, 0})) displacement.x = 0;
  if (!Includes(strides, {0, 1, 0})) displacement.y = 0;
  if (!Includes(strides, {0, 0, 1})) displacement.yaw = 0;
  RouteLeg leg;
  leg.gait = gait;
  leg.from = {0.2 * random(), 0.2 * random(), 3 * random()};
  leg.to = leg.from * displacement;
  return leg;
}

void ExpectWaysThroughSmallRoomsVerify(const LocomotionModel& model, StrideClass strides, int count,
                                       unsigned seed) {
  std::mt19937 generator(seed);
  for (int trial = 0; trial < count; ++trial) {
    const int gait = trial % static_cast<int>(model.gaits.size());
    const RouteLeg leg = RandomLeg(strides, gait, &generator);
    Room room(&generator);
    ASSERT_TRUE(IsSufficient(model, room, leg));
    Shrink(model, leg, &room);
    const LegScene scene(model, room.Environment());
    ASSERT_TRUE(scene.action(gait).CS(LegEdge(model, leg)));
    EXPECT_TRUE(scene.action(gait).CN(LegEdge(model, leg)));
    const VerificationReport report = scene.VerifyLeg(leg);
    EXPECT_TRUE(report.accepted()) << FormatText(report);
  }
}

class SmallRooms : public testing::TestWithParam<StrideClass> {};
TEST_P(SmallRooms, WhatIsSufficientInThemVerifies) {
  ExpectWaysThroughSmallRoomsVerify(DrcHubo1Locomotion(), GetParam(), 2, 1);
  ExpectWaysThroughSmallRoomsVerify(QuadrupedLocomotion(), GetParam(), 2, 2);
}
INSTANTIATE_TEST_SUITE_P(Classes, SmallRooms, testing::ValuesIn(kStrideClasses));

class SmallRoomsLong : public testing::TestWithParam<StrideClass> {};
TEST_P(SmallRoomsLong, WhatIsSufficientInThemVerifies) {
  ExpectWaysThroughSmallRoomsVerify(DrcHubo1Locomotion(), GetParam(), 100, 3);
  ExpectWaysThroughSmallRoomsVerify(QuadrupedLocomotion(), GetParam(), 100, 4);
}
INSTANTIATE_TEST_SUITE_P(Classes, SmallRoomsLong, testing::ValuesIn(kStrideClasses));

/// A stance 8 cm from a wall is one, whichever way it faces; a stance that touches is none.
TEST(SmallRoom, StandingNeedsTheRoomOfThePostureAlone) {
  const LocomotionModel& model = DrcHubo1Locomotion();
  for (int gait = 0; gait < 2; ++gait) {
    Eigen::AlignedBox3d hull;
    for (const Eigen::AlignedBox3d& box : model.gaits[gait]->volumes.standing) hull.extend(box);
    const double faces[] = {hull.max().x(), hull.max().y(), -hull.min().x(), -hull.min().y()};
    for (int side = 0; side < 4; ++side) {
      const auto wall_at = [&](double distance) {
        models::Environment environment;
        environment.bounds = Eigen::AlignedBox2d(Eigen::Vector2d(-3, -3), Eigen::Vector2d(3, 3));
        models::Obstacle floor;
        floor.shape = models::Shape::Box({8, 8, 0.2});
        floor.X_WO.translation().z() = -0.1;
        floor.is_ground = true;
        models::Obstacle wall;
        wall.shape = models::Shape::Box({0.1, 6, 2});
        wall.X_WO = (PlanarPose{0, 0, side * M_PI / 2} * PlanarPose{distance + 0.05, 0, 0}).At(1);
        environment.obstacles = {floor, wall};
        return environment;
      };
      const auto examine = [&](double gap) {
        return LegScene(model, wall_at(faces[side] + gap)).action(gait).Examine({gait, {}, 0});
      };
      EXPECT_EQ(examine(0.08), StanceFault::kNone);
      EXPECT_EQ(examine(0.005), StanceFault::kNone);
      EXPECT_EQ(examine(-0.005), StanceFault::kCollision);
    }
  }
}

}  // namespace
}  // namespace possibility::actions
