#include "models/world/collision.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "models/shapes/signed_distance.h"
#include "tests/models/random_geometry.h"

namespace possibility::models {
namespace {

using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Vector3d;
using testing::RandomGeometry;

constexpr double kFarAway = 1e9;

double PairDistance(const Shape& a, const Isometry3d& X_WA, const Shape& b,
                    const Isometry3d& X_WB) {
  const PreparedShape A(a), B(b);
  return SignedDistance(A, A.CorePose(X_WA), B, B.CorePose(X_WB), kFarAway);
}

/// A floor and `count` shapes scattered over it.
Environment RandomScene(int count, double half_width, RandomGeometry* random) {
  Environment environment;
  Isometry3d X_floor = Isometry3d::Identity();
  X_floor.translation().z() = -0.05;
  environment.obstacles.push_back({"floor", Shape::Box({20, 20, 0.1}), X_floor, true});
  for (int i = 0; i < count; ++i) {
    Isometry3d X = random->Pose(half_width);
    X.translation().z() = random->Uniform(0, 1.5);
    environment.obstacles.push_back({std::to_string(i), random->AnyShape(2), X, false});
  }
  return environment;
}

/// A chain of links with up to two shapes each.
RobotModel RandomChain(int num_links, RandomGeometry* random) {
  RobotModel robot;
  for (int i = 0; i < num_links; ++i) {
    Link link;
    for (int shape = random->Index(3); shape > 0; --shape) {
      link.shapes.push_back({random->AnyShape(), random->Pose(0.1)});
    }
    robot.links.push_back(link);
    if (i > 0) {
      Joint joint;
      joint.parent = i - 1;
      robot.joints.push_back(joint);
    }
  }
  return robot;
}

std::vector<Isometry3d> RandomPoses(int count, double spread, RandomGeometry* random) {
  std::vector<Isometry3d> X_WL;
  for (int i = 0; i < count; ++i) {
    X_WL.push_back(random->Pose(spread));
    X_WL.back().translation().z() = random->Uniform(0, 1);
  }
  return X_WL;
}

void ExpectSame(const std::vector<Proximity>& found, const std::vector<Proximity>& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(found[i].link, expected[i].link);
    EXPECT_EQ(found[i].other, expected[i].other);
    EXPECT_NEAR(found[i].distance, expected[i].distance, 1e-6);
  }
}

/// The distance of the link's nearest shape to the other link's shapes or the obstacle's.
double LinkDistance(const Link& link, const Isometry3d& X_WL, const std::vector<PosedShape>& others,
                    const Isometry3d& X_WO) {
  double nearest = kFarAway;
  for (const PosedShape& a : link.shapes) {
    for (const PosedShape& b : others) {
      nearest = std::min(nearest, PairDistance(a.shape, X_WL * a.X_PS, b.shape, X_WO * b.X_PS));
    }
  }
  return nearest;
}

TEST(CollisionChecker, EnvironmentProximitiesAreThoseOfAllPairs) {
  RandomGeometry random(1);
  for (const int count : {0, 1, 12, 150}) {
    const Environment environment = RandomScene(count, 2, &random);
    const RobotModel robot = RandomChain(8, &random);
    const CollisionChecker checker(robot, environment);
    for (int trial = 0; trial < 40; ++trial) {
      const std::vector<Isometry3d> X_WL = RandomPoses(8, 2, &random);
      const double threshold = std::vector{0.0, 0.05, 0.5, -0.02}[trial % 4];
      std::vector<Proximity> expected;
      for (int link = 0; link < 8; ++link) {
        for (size_t i = 0; i < environment.obstacles.size(); ++i) {
          const Obstacle& obstacle = environment.obstacles[i];
          const double distance =
              LinkDistance(robot.links[link], X_WL[link],
                           {{obstacle.shape, Isometry3d::Identity()}}, obstacle.X_WO);
          if (distance < threshold) expected.push_back({link, static_cast<int>(i), distance});
        }
      }
      ExpectSame(checker.EnvironmentProximities(X_WL, threshold), expected);
    }
  }
}

TEST(CollisionChecker, SelfProximitiesSkipNeighboursAndIgnoredPairs) {
  RandomGeometry random(2);
  int found = 0;
  for (int model = 0; model < 20; ++model) {
    RobotModel robot = RandomChain(7, &random);
    robot.ignored_collisions = {{0, 3}, {6, 2}};
    const CollisionChecker checker(robot, Environment());
    for (int trial = 0; trial < 30; ++trial) {
      const std::vector<Isometry3d> X_WL = RandomPoses(7, 0.3, &random);
      const double threshold = trial % 2 == 0 ? 0 : 0.03;
      std::vector<Proximity> expected;
      for (int a = 0; a < 7; ++a) {
        for (int b = a + 2; b < 7; ++b) {
          const std::pair<int, int> pair(a, b);
          if (pair == std::pair(0, 3) || pair == std::pair(2, 6)) continue;
          const double distance =
              LinkDistance(robot.links[a], X_WL[a], robot.links[b].shapes, X_WL[b]);
          if (distance < threshold) expected.push_back({a, b, distance});
        }
      }
      found += static_cast<int>(expected.size());
      ExpectSame(checker.SelfProximities(X_WL, threshold), expected);
    }
  }
  EXPECT_GT(found, 100);
}

TEST(CollisionChecker, ClearanceIsTheNearestObstaclesDistance) {
  RandomGeometry random(3);
  const Environment environment = RandomScene(60, 2, &random);
  const CollisionChecker checker(environment);
  for (int trial = 0; trial < 1000; ++trial) {
    const Shape shape = random.AnyShape();
    const PreparedShape prepared(shape);
    Isometry3d X = random.Pose(2);
    X.translation().z() = random.Uniform(-0.1, 2);
    double exact = kFarAway;
    for (const Obstacle& obstacle : environment.obstacles) {
      exact = std::min(exact, PairDistance(shape, X, obstacle.shape, obstacle.X_WO));
    }
    const double at_most = random.Uniform(0, 0.6);
    EXPECT_NEAR(checker.Clearance(prepared, X, at_most), std::min(exact, at_most), 1e-6);
    EXPECT_LE(checker.Clearance(prepared, X, at_most), std::min(exact, at_most) + 1e-9);
    for (const double margin : {0.0, 0.02, 0.2}) {
      if (std::abs(exact - margin) > 1e-6) {
        EXPECT_EQ(checker.IsFree(prepared, X, margin), exact > margin);
        EXPECT_EQ(checker.IsFree(shape, X, margin), exact > margin);
      }
    }
  }
}

/// The supporting planes of shape and obstacle normal to a random direction are `gap` apart, with
/// the support points face to face. Their distance is exactly the gap.
TEST(CollisionChecker, IsNeverFreeWithinTheMargin) {
  RandomGeometry random(4);
  for (int trial = 0; trial < 20000; ++trial) {
    Environment environment;
    environment.obstacles.push_back(
        {"only", random.AnyShape(trial % 2 == 0 ? 40 : 2), random.Pose(5), false});
    const Obstacle& obstacle = environment.obstacles.front();
    const CollisionChecker checker(environment);
    const Shape shape = random.AnyShape();
    Isometry3d X = random.Pose(5);
    const Vector3d n =
        trial % 3 == 0 ? Vector3d(obstacle.X_WO.linear().col(random.Index(3))) : random.Direction();
    const double margin = trial % 4 == 0 ? 0 : random.Uniform(0, 0.1);
    const double error = std::min(margin, std::pow(10, random.Uniform(-7, -2)));
    const Vector3d on_obstacle =
        obstacle.X_WO * obstacle.shape.Support(obstacle.X_WO.linear().transpose() * n);
    const Vector3d on_shape = X * shape.Support(-X.linear().transpose() * n);
    X.translation() += on_obstacle - on_shape + (margin - error) * n;
    EXPECT_FALSE(checker.IsFree(shape, X, margin)) << trial;
    X.translation() += (error + 1e-4) * n;
    EXPECT_TRUE(checker.IsFree(shape, X, margin)) << trial;
  }
}

/// Two points, one well inside each shape, coincide.
TEST(CollisionChecker, IsNeverFreeInOverlap) {
  RandomGeometry random(10);
  const auto inner_point = [&](const Shape& shape) {
    Vector3d centre = Vector3d::Zero();
    for (const Vector3d& vertex : shape.vertices) centre += vertex / shape.vertices.size();
    const Vector3d between = random.Uniform(0, 1) * (shape.Support(random.Direction()) - centre) +
                             random.Uniform(0, 1) * (shape.Support(random.Direction()) - centre);
    return Vector3d(centre + 0.4999 * between);
  };
  for (int trial = 0; trial < 20000; ++trial) {
    Environment environment;
    environment.obstacles.push_back(
        {"only", random.AnyShape(trial % 2 == 0 ? 40 : 2), random.Pose(5), false});
    const Obstacle& obstacle = environment.obstacles.front();
    const Shape shape = random.AnyShape();
    Isometry3d X = random.Pose(5);
    X.translation() += obstacle.X_WO * inner_point(obstacle.shape) - X * inner_point(shape);
    EXPECT_FALSE(CollisionChecker(environment).IsFree(shape, X, 0)) << trial;
  }
}

TEST(CollisionChecker, TouchingIsNotFree) {
  RandomGeometry random(5);
  const CollisionChecker checker(RandomScene(0, 1, &random));
  for (int trial = 0; trial < 1000; ++trial) {
    const Shape box = Shape::Box({0.3, 0.2, random.Uniform(0.1, 1)});
    Isometry3d X = random.UprightPose(8);
    X.translation().z() = box.size.z() / 2;
    EXPECT_FALSE(checker.IsFree(box, X, 0));
    X.translation().z() += 1e-4;
    EXPECT_TRUE(checker.IsFree(box, X, 0));
  }
}

TEST(CollisionChecker, SoleAtRestHasNoDepth) {
  RandomGeometry random(6);
  RobotModel robot;
  robot.links.resize(1);
  Isometry3d X_LS = Isometry3d::Identity();
  X_LS.translation() = Vector3d(0.05, 0, -0.1);
  robot.links[0].shapes.push_back({Shape::Box({0.24, 0.14, 0.04}), X_LS});
  const CollisionChecker checker(robot, RandomScene(0, 1, &random));
  for (int trial = 0; trial < 2000; ++trial) {
    Isometry3d X_WL = random.UprightPose(6.5);
    X_WL.translation().z() = 0.12;
    const std::vector<Proximity> close = checker.EnvironmentProximities({X_WL}, 0.01);
    ASSERT_EQ(close.size(), 1u);
    EXPECT_LT(std::abs(close[0].distance), 5e-5);
  }
}

TEST(CollisionChecker, ClearanceIsExactInALargeScene) {
  RandomGeometry random(7);
  const Environment environment = RandomScene(10000, 9, &random);
  const CollisionChecker checker(environment);
  for (int trial = 0; trial < 20; ++trial) {
    const Shape box = Shape::Box({0.1, 0.1, 0.1});
    Isometry3d X = random.Pose(9);
    X.translation().z() = random.Uniform(0.2, 2);
    double exact = kFarAway;
    for (const Obstacle& obstacle : environment.obstacles) {
      exact = std::min(exact, PairDistance(box, X, obstacle.shape, obstacle.X_WO));
    }
    EXPECT_NEAR(checker.Clearance(PreparedShape(box), X, kFarAway), exact, 1e-6);
  }
}

TEST(CollisionChecker, OneCheckerServesTwoThreads) {
  RandomGeometry random(8);
  const Environment environment = RandomScene(50, 1.5, &random);
  const RobotModel robot = RandomChain(10, &random);
  const CollisionChecker checker(robot, environment);
  std::vector<std::vector<Isometry3d>> poses;
  for (int i = 0; i < 100; ++i) poses.push_back(RandomPoses(10, 1, &random));
  const auto query = [&] {
    std::vector<Proximity> all;
    for (const std::vector<Isometry3d>& X_WL : poses) {
      for (const Proximity& p : checker.EnvironmentProximities(X_WL, 0.02)) all.push_back(p);
      for (const Proximity& p : checker.SelfProximities(X_WL, 0.02)) all.push_back(p);
    }
    return all;
  };
  const std::vector<Proximity> alone = query();
  std::vector<Proximity> first, second;
  {
    std::jthread a([&] { first = query(); });
    std::jthread b([&] { second = query(); });
  }
  EXPECT_FALSE(alone.empty());
  ExpectSame(first, alone);
  ExpectSame(second, alone);
}

TEST(CollisionChecker, WrongNumbersOfPosesAreRefusedAndNaNCollides) {
  RandomGeometry random(9);
  RobotModel robot = RandomChain(1, &random);
  robot.links.resize(3);
  for (Link& link : robot.links) {
    link.shapes = {{Shape::Sphere(0.1), Isometry3d::Identity()}};
  }
  robot.joints.resize(2);
  const CollisionChecker checker(robot, RandomScene(2, 1, &random));
  EXPECT_THROW(checker.EnvironmentProximities({}, 0), std::invalid_argument);
  EXPECT_THROW(checker.SelfProximities(RandomPoses(4, 1, &random), 0), std::invalid_argument);
  std::vector<Isometry3d> X_WL = RandomPoses(3, 1, &random);
  X_WL[1].translation().x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(checker.IsFree(Shape::Box({1, 1, 1}), X_WL[1], 0));
  const std::vector<Proximity> close = checker.EnvironmentProximities(X_WL, 0);
  EXPECT_EQ(std::count_if(close.begin(), close.end(), [](const auto& p) { return p.link == 1; }),
            3);
  EXPECT_FALSE(checker.SelfProximities(X_WL, 0).empty());
}

}  // namespace
}  // namespace possibility::models
