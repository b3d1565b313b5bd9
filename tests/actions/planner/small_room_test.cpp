// Rooms so small that C_S only just lets the robot move in them, by class of stride. The ways that
// C_S lets through must still verify.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "actions/conditions/exploration_pose.h"
#include "actions/flood/dead_end.h"
#include "actions/flood/flood_oracle.h"
#include "actions/planner/planner.h"
#include "actions/verify/verification_report.h"
#include "tests/actions/drchubo1.h"
#include "tests/actions/lattice_proposal.h"
#include "tests/actions/planner/leg_scene.h"
#include "tests/actions/quadruped.h"

namespace possibility::actions {
namespace {

models::Obstacle Box(const std::string& name, const Eigen::Vector3d& low,
                     const Eigen::Vector3d& high) {
  models::Obstacle obstacle;
  obstacle.name = name;
  obstacle.shape = models::Shape::Box(high - low);
  obstacle.X_WO.translation() = (low + high) / 2;
  return obstacle;
}

/// Walls around the origin, each with the direction it stands in and its distance.
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
    EXPECT_FALSE(FindDeadEnd(model, scene.world(), {}, {gait, leg.from, 0}, {{gait, leg.to, 0}}));
    const VerificationReport report = scene.VerifyLeg(leg);
    EXPECT_TRUE(report.accepted()) << FormatText(report);
  }
}

class SmallRooms : public ::testing::TestWithParam<StrideClass> {};
TEST_P(SmallRooms, SufficientWaysVerify) {
  ExpectWaysThroughSmallRoomsVerify(DrcHubo1Locomotion(), GetParam(), 2, 1);
  ExpectWaysThroughSmallRoomsVerify(QuadrupedLocomotion(), GetParam(), 1, 2);
}
INSTANTIATE_TEST_SUITE_P(Classes, SmallRooms, ::testing::ValuesIn(kStrideClasses));

class SmallRoomsLong : public ::testing::TestWithParam<StrideClass> {};
TEST_P(SmallRoomsLong, SufficientWaysVerify) {
  ExpectWaysThroughSmallRoomsVerify(DrcHubo1Locomotion(), GetParam(), 40, 3);
  ExpectWaysThroughSmallRoomsVerify(QuadrupedLocomotion(), GetParam(), 40, 4);
}
INSTANTIATE_TEST_SUITE_P(Classes, SmallRoomsLong, ::testing::ValuesIn(kStrideClasses));

/// A stance 8 cm from a wall is free, whichever way it faces. A stance that touches is not.
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

/// A robot that leans from foot to foot so close to a wall would touch it.
TEST(SmallRoom, AStanceThatNoStrideCanLeaveIsExhausted) {
  const LocomotionModel walking = DrcHubo1Walking();
  const GroundedStance beside{0, {0, 0, 0}, 0}, away{0, {0.5, -1, 0}, 0};
  for (const bool begins : {true, false}) {
    for (const double gap : {0.05, 0.1}) {
      models::Environment environment;
      environment.bounds = Eigen::AlignedBox2d(Eigen::Vector2d(-3, -3), Eigen::Vector2d(3, 3));
      environment.obstacles = {Box("floor", {-4, -4, -0.2}, {4, 4, 0}),
                               Box("wall", {-3, 0.356 + gap, 0}, {3, 0.5 + gap, 2})};
      environment.obstacles.front().is_ground = true;
      const LegScene scene(walking, environment);
      EXPECT_EQ(scene.action(0).Examine(beside), StanceFault::kNone);
      const std::vector<std::shared_ptr<Manoeuvre>> nothing_else;
      FloodOracle oracle(walking, scene.world(), nothing_else, 0.1, {});
      const auto answer = begins ? oracle.Ask(beside, {away}) : oracle.Ask(away, {beside});
      if (gap < 0.08) {
        EXPECT_EQ(answer, graph::RouteOracleAnswer::kExhausted);
        EXPECT_EQ(oracle.barrier().closed_by, std::vector<std::string>{"wall"});
      } else {
        EXPECT_EQ(answer, graph::RouteOracleAnswer::kUnknown);
      }
      EXPECT_FALSE(FindDeadEnd(walking, scene.world(), {}, beside, {beside}));
    }
  }
}

/// Two rooms and a door between them, straight ahead of the start.
models::Scenario DoorScene(double width) {
  models::Scenario scenario;
  scenario.name = scenario.file = "door.yaml";
  scenario.robot_file = DrcHubo1().file;
  scenario.actions = {"walk"};
  scenario.start = {"walk", -1.5, 0, 0, 0};
  scenario.goals = {{"walk", 1.5, 0, 0, 0}};
  scenario.environment.bounds =
      Eigen::AlignedBox2d(Eigen::Vector2d(-2.5, -1.5), Eigen::Vector2d(2.5, 1.5));
  scenario.environment.obstacles = {
      Box("floor", {-2.5, -1.5, -0.5}, {2.5, 1.5, 0}),
      Box("left_wall", {-0.1, width / 2, 0}, {0.1, 1.5, 2}),
      Box("right_wall", {-0.1, -1.5, 0}, {0.1, -width / 2, 2}),
  };
  scenario.environment.obstacles.front().is_ground = true;
  return scenario;
}

TEST(SmallRoom, WalksStraightThroughADoorOf95Centimetres) {
  PlanRequest request;
  request.library = DrcHubo1Library();
  request.time_limit = 1000;  // sanitizers are slow
  const PlanResult result = PlanTraversal(DrcHubo1(), DoorScene(0.95), request);
  ASSERT_EQ(result.status, PlanStatus::kFound) << result.explanation;
  EXPECT_TRUE(result.verification.accepted()) << FormatText(result.verification);
  for (const Segment& segment : result.plan.segments) {
    for (const Phase& phase : segment.phases) {
      for (const Knot& knot : phase.knots) {
        // The root turns by up to 0.3 rad with the steps; aside it would be 1.57 rad.
        EXPECT_LT(std::abs(knot.q[3]), std::sin(0.31 / 2)) << "it turns at " << knot.t;
        EXPECT_LT(std::abs(knot.q[5]), 0.1) << "it steps aside at " << knot.t;
      }
    }
  }
}

/// Posts 1 m apart, as far as the bounds.
models::Environment Posts() {
  models::Environment environment;
  environment.bounds = Eigen::AlignedBox2d(Eigen::Vector2d(0, 0), Eigen::Vector2d(14, 5));
  environment.obstacles = {Box("floor", {-1, -1, -0.5}, {15, 6, 0})};
  environment.obstacles.front().is_ground = true;
  for (int x = 2; x <= 12; ++x) {
    for (int y = 0; y <= 5; ++y) {
      models::Obstacle post;
      post.shape = models::Shape::Cylinder(0.075, 1.5);
      post.X_WO.translation() << x, y, 0.75;
      environment.obstacles.push_back(post);
    }
  }
  return environment;
}

/// The places that the search examines may lie anywhere between the posts.
TEST(SmallRoom, WaysBetweenPostsAreFoundWhereverTheyBegin) {
  const LocomotionModel walking = DrcHubo1Walking();
  const models::Environment environment = Posts();
  const models::GroundMap ground(environment);
  const World world{&environment, &ground};
  const auto space = std::make_shared<PelvisPoseSpace>(environment.bounds, ground.levels(), 0.137);
  const std::vector<std::shared_ptr<QuasiStaticAction>> gaits = {
      std::make_shared<QuasiStaticAction>(walking, 0, world, space, 0.25)};
  const std::vector<std::shared_ptr<SearchedManoeuvre>> nothing_else;
  for (double y = 0.55; y < 0.9; y += 0.05) {
    const GroundedStance start{0, {0.69, y, 0}, 0};
    const GroundedStance goal{0, {12.99, y, 0}, 0};
    EXPECT_FALSE(FirstProposal({&walking, &gaits, &nothing_else}, start, {goal}).empty()) << y;
  }
}

}  // namespace
}  // namespace possibility::actions
