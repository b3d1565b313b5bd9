#include "actions/wholebody/motion_collision.h"

#include <gtest/gtest.h>

#include "actions/motion/phase_sequence.h"
#include "tests/actions/drchubo1.h"

namespace possibility::actions {
namespace {

/// The nominal stance slides ahead by 1 m in 1 s.
std::vector<Phase> Slide() {
  Phase phase;
  for (const double t : {0.0, 1.0}) {
    Knot knot;
    knot.t = t;
    knot.q = DrcHubo1Locomotion().gaits[0]->stance.q;
    knot.q[4] += t;
    knot.v = knot.a = Eigen::VectorXd::Zero(knot.q.size() - 1);
    knot.v[3] = 1;
    phase.knots.push_back(knot);
  }
  return {phase};
}

/// A wall whose near side is at x.
models::Environment WallAt(double x) {
  models::Environment environment;
  models::Obstacle& wall = environment.obstacles.emplace_back();
  wall.name = "wall";
  wall.shape = models::Shape::Box({1, 20, 4});
  wall.X_WO.translation() << x + 0.5, 0, 2;
  return environment;
}

TEST(MotionCollisionTest, TheFirstHitComesWhenTheRobotReachesTheWall) {
  const models::RobotModel& robot = DrcHubo1();
  const double front = [&] {
    // The robot is free at 0 s only if the wall is in front of its foremost point.
    for (double x = 0.1;; x += 0.001) {
      const models::Environment environment = WallAt(x);
      const models::CollisionChecker checker(robot, environment);
      std::vector<Phase> still = Slide();
      still.front().knots.back().q = still.front().knots.front().q;
      still.front().knots.back().v.setZero();
      still.front().knots.front().v.setZero();
      if (FirstHit(robot, environment, checker, still).empty()) return x;
    }
  }();
  for (const double away : {0.25, 0.5, 0.9}) {
    const models::Environment environment = WallAt(front + away);
    const models::CollisionChecker checker(robot, environment);
    const std::string hit = FirstHit(robot, environment, checker, Slide());
    const std::size_t at = hit.rfind(" at ");
    ASSERT_NE(at, std::string::npos) << hit;
    EXPECT_NEAR(std::stod(hit.substr(at + 4)), away, 0.011) << hit;
    EXPECT_NE(hit.find("'wall'"), std::string::npos);
  }
  const models::Environment environment = WallAt(front + 1.01);
  const models::CollisionChecker checker(robot, environment);
  EXPECT_TRUE(FirstHit(robot, environment, checker, Slide()).empty());
}

TEST(MotionCollisionTest, AMotionHitsWhereItsPosesHitFromTheSamePlace) {
  const models::RobotModel& robot = DrcHubo1();
  const MotionPoses poses(robot, Slide());
  for (const double x : {0.6, 1.1, 1.4, 3.0}) {
    const models::Environment environment = WallAt(x);
    const models::CollisionChecker checker(robot, environment);
    for (const PlanarPose& place : {PlanarPose{}, PlanarPose{0.3, -2, 0.4}}) {
      EXPECT_EQ(FirstHit(robot, environment, checker, poses, place.At(0)),
                FirstHit(robot, environment, checker, Placed(Slide(), place, 0)))
          << x;
    }
  }
}

/// A rough motion hits a wall where the robot at a knot hits one that is nearer by the roughness.
TEST(MotionCollisionTest, ARoughHitIsOneByMoreThanTheRoughness) {
  const models::RobotModel& robot = DrcHubo1();
  std::vector<Phase> last = Slide();
  last.front().knots.front().q = last.front().knots.back().q;
  for (Knot& knot : last.front().knots) knot.v.setZero();
  const double roughness = 0.02;
  int hits = 0, misses = 0;
  for (double x = 1.1; x < 1.6; x += 0.003) {
    const models::Environment here = WallAt(x);
    const models::Environment farther = WallAt(x + roughness);
    const std::string rough =
        FirstRoughHit(robot, here, models::CollisionChecker(robot, here), Slide(), roughness);
    const std::string hit =
        FirstHit(robot, farther, models::CollisionChecker(robot, farther), last);
    EXPECT_EQ(rough.empty(), hit.empty()) << x;
    ++(rough.empty() ? misses : hits);
  }
  EXPECT_GT(hits, 10);
  EXPECT_GT(misses, 10);
}

TEST(MotionCollisionTest, ASelfHitNamesBothLinks) {
  const models::RobotModel& robot = DrcHubo1();
  const models::CollisionChecker checker(robot, {});
  std::vector<Phase> motion = Slide();
  EXPECT_TRUE(FirstSelfHit(robot, checker, motion).empty());
  // Both hips roll inwards until the legs meet.
  for (int j = 0; j < robot.num_joints(); ++j) {
    if (robot.joints[j].name == "LHR") motion.front().knots.back().q[7 + j] = -0.5;
    if (robot.joints[j].name == "RHR") motion.front().knots.back().q[7 + j] = 0.5;
  }
  EXPECT_NE(FirstSelfHit(robot, checker, motion).find("hits "), std::string::npos);
}

TEST(MotionCollisionTest, ACancelledSearchEnds) {
  const models::RobotModel& robot = DrcHubo1();
  const models::Environment environment = WallAt(0.2);
  const models::CollisionChecker checker(robot, environment);
  const CancellationToken cancelled([] { return false; });
  EXPECT_TRUE(FirstHit(robot, environment, checker, Slide(), cancelled).empty());
}

}  // namespace
}  // namespace possibility::actions
