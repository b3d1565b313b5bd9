#include "models/world/ground_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "models/input/input_error.h"
#include "models/robot/rotation_vector.h"
#include "tests/models/random_geometry.h"

namespace possibility::models {
namespace {

using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using testing::RandomGeometry;

/// A box of ground whose top is centred at (x, y) at height z.
Obstacle Ground(double x, double y, double z, double length, double width, double yaw = 0) {
  Obstacle obstacle{"ground", Shape::Box({length, width, 0.2}), Isometry3d::Identity(), true};
  obstacle.X_WO.translation() = Vector3d(x, y, z - 0.1);
  obstacle.X_WO.rotate(AngleAxisd(yaw, Vector3d::UnitZ()));
  return obstacle;
}

GroundMap Map(std::vector<Obstacle> obstacles) {
  Environment environment;
  environment.obstacles = std::move(obstacles);
  return GroundMap(environment);
}

bool IsOnTop(const Obstacle& obstacle, const Vector2d& p) {
  const Vector3d local = obstacle.X_WO.inverse() * Vector3d(p.x(), p.y(), 0);
  return std::abs(local.x()) <= obstacle.shape.size.x() / 2 &&
         std::abs(local.y()) <= obstacle.shape.size.y() / 2;
}

bool AnyGroundAt(const std::vector<Obstacle>& obstacles, const Vector2d& p) {
  return std::any_of(obstacles.begin(), obstacles.end(),
                     [&](const Obstacle& obstacle) { return IsOnTop(obstacle, p); });
}

TEST(GroundMap, RectangleHasAClosedForm) {
  const GroundMap map = Map({Ground(1, 2, 0.3, 4, 2, 0.7)});
  RandomGeometry random(1);
  ASSERT_EQ(map.levels().size(), 1u);
  EXPECT_DOUBLE_EQ(map.levels()[0], 0.3);
  for (int trial = 0; trial < 2000; ++trial) {
    const Vector2d p(random.Uniform(-3, 5), random.Uniform(-2, 6));
    const Vector2d local = Eigen::Rotation2Dd(-0.7) * (p - Vector2d(1, 2));
    const Eigen::Array2d outside = local.array().abs() - Eigen::Array2d(2, 1);
    const double distance =
        outside.maxCoeff() > 0 ? -outside.max(0).matrix().norm() : -outside.maxCoeff();
    EXPECT_NEAR(map.Clearance(0, p), distance, 1e-6);
  }
}

TEST(GroundMap, AWayHeldByOneFaceIsClearAlongTheLine) {
  RandomGeometry random(5);
  int held = 0;
  for (int scene = 0; scene < 40; ++scene) {
    const GroundMap map = Map({Ground(0, 0, 0, 4, 3, random.Uniform(-4, 4)),
                               Ground(2.5, 0.5, 0, 2, 4, random.Uniform(-4, 4))});
    for (int trial = 0; trial < 100; ++trial) {
      const Vector2d from(random.Uniform(-3, 4), random.Uniform(-3, 3));
      const Vector2d to(random.Uniform(-3, 4), random.Uniform(-3, 3));
      const double radius = random.Uniform(0, 0.8);
      if (!map.OneFaceHolds(0, from, to, radius)) continue;
      ++held;
      for (int i = 0; i <= 10; ++i) {
        EXPECT_GE(map.Clearance(0, from + i / 10.0 * (to - from)), radius - 1e-6);
      }
    }
  }
  EXPECT_GT(held, 100);
  // On a single face the answer is exact.
  const GroundMap map = Map({Ground(0, 0, 0, 4, 2)});
  EXPECT_TRUE(map.OneFaceHolds(0, {-1.4, 0.4}, {1.4, -0.4}, 0.59));
  EXPECT_FALSE(map.OneFaceHolds(0, {-1.4, 0.4}, {1.4, -0.4}, 0.61));
  EXPECT_FALSE(map.OneFaceHolds(0, {0, 0}, {std::nan(""), 0}, 0.1));
  EXPECT_THROW(map.OneFaceHolds(1, {0, 0}, {0, 0}, 0.1), std::out_of_range);
}

/// Within the clearance of p all points are alike; a little farther, some point differs.
TEST(GroundMap, UnionsOfYawedBoxesAgreeWithPointSampling) {
  RandomGeometry random(2);
  int inside = 0, outside = 0, unseen = 0;
  for (int scene = 0; scene < 60; ++scene) {
    std::vector<Obstacle> obstacles;
    for (int i = 1 + random.Index(30); i > 0; --i) {
      obstacles.push_back(Ground(random.Uniform(-2, 2), random.Uniform(-2, 2), 0,
                                 random.Uniform(0.2, 2), random.Uniform(0.2, 2),
                                 random.Index(3) == 0 ? 0 : random.Uniform(-4, 4)));
    }
    const GroundMap map = Map(obstacles);
    for (int trial = 0; trial < 60; ++trial) {
      const Vector2d p(random.Uniform(-3, 3), random.Uniform(-3, 3));
      const double clearance = map.Clearance(0, p);
      const bool is_ground = AnyGroundAt(obstacles, p);
      if (std::abs(clearance) < 1e-5) continue;
      EXPECT_EQ(clearance > 0, is_ground);
      (is_ground ? inside : outside) += 1;
      EXPECT_EQ(map.LevelAt(p, 0, 0.01).has_value(), is_ground);
      bool differs_beyond = false;
      for (int i = 0; i < 720; ++i) {
        const Vector2d u = Eigen::Rotation2Dd(i * M_PI / 360) * Vector2d::UnitX();
        const double share = i % 2 == 0 ? 1 : random.Uniform(0, 1);
        EXPECT_EQ(AnyGroundAt(obstacles, p + share * (std::abs(clearance) - 2e-6) * u), is_ground);
        for (const double beyond : {1e-3, 3e-3, 0.01, 0.03}) {
          differs_beyond |=
              AnyGroundAt(obstacles, p + (std::abs(clearance) + beyond) * u) != is_ground;
        }
      }
      if (!differs_beyond) ++unseen;
    }
  }
  // Rings of samples may miss a sliver of ground or a small hole.
  EXPECT_LT(unseen, 20);
  EXPECT_GT(inside, 500);
  EXPECT_GT(outside, 500);
}

TEST(GroundMap, IsNearAgreesWithTheClearance) {
  RandomGeometry random(6);
  int near = 0, far = 0;
  for (int scene = 0; scene < 40; ++scene) {
    std::vector<Obstacle> obstacles;
    for (int i = 1 + random.Index(8); i > 0; --i) {
      obstacles.push_back(Ground(random.Uniform(-2, 2), random.Uniform(-2, 2), 0,
                                 random.Uniform(0.2, 2), random.Uniform(0.2, 2),
                                 random.Uniform(-4, 4)));
    }
    const GroundMap map = Map(obstacles);
    for (int trial = 0; trial < 100; ++trial) {
      const Vector2d p(random.Uniform(-4, 4), random.Uniform(-4, 4));
      const double distance = random.Index(5) == 0 ? 0 : random.Uniform(0, 1.5);
      const double clearance = map.Clearance(0, p);
      if (std::abs(clearance + distance) < 3e-6) continue;
      const bool is_near = map.IsNear(0, p, distance);
      EXPECT_EQ(is_near, clearance > -distance) << p.transpose() << ", " << distance;
      (is_near ? near : far) += 1;
    }
  }
  EXPECT_GT(near, 500);
  EXPECT_GT(far, 500);
  const GroundMap map = Map({Ground(0, 0, 0, 4, 2)});
  EXPECT_FALSE(map.IsNear(0, {std::nan(""), 0}, 1));
  EXPECT_THROW(map.IsNear(1, {0, 0}, 1), std::out_of_range);
}

TEST(GroundMap, AbuttingFacesHaveNoSeam) {
  for (const double yaw : {0.0, 0.3, 1.1}) {
    for (const double gap : {0.0, 1e-9, 9e-7, -1e-9, -1e-3}) {
      std::vector<Obstacle> tiles;
      for (int i = -2; i <= 2; ++i) {
        for (int j = -2; j <= 2; ++j) {
          const Vector2d centre = Eigen::Rotation2Dd(yaw) * ((1 + gap) * Vector2d(i, j));
          tiles.push_back(Ground(centre.x(), centre.y(), 0.5, 1, 1, yaw));
        }
      }
      const GroundMap map = Map(tiles);
      ASSERT_EQ(map.levels().size(), 1u);
      RandomGeometry random(3);
      const double half_width = 2.5 + 2 * gap;
      for (int trial = 0; trial < 200; ++trial) {
        Vector2d local(random.Uniform(-2.4, 2.4), random.Uniform(-2.4, 2.4));
        if (trial % 2 == 0) local.x() = (1 + gap) * (random.Index(4) - 1.5);
        const double exact = half_width - local.cwiseAbs().maxCoeff();
        EXPECT_NEAR(map.Clearance(0, Eigen::Rotation2Dd(yaw) * local), exact, 2e-6);
      }
    }
  }
}

TEST(GroundMap, IdenticalFacesHaveTheClearanceOfOne) {
  RandomGeometry random(4);
  for (int trial = 0; trial < 200; ++trial) {
    const double yaw = random.Uniform(-4, 4), x = random.Uniform(-9, 9);
    const Obstacle face = Ground(x, 1, 0, 2, 2, yaw);
    const GroundMap map = Map({face, face, Ground(x, 1, 0, 2, 2, yaw + M_PI / 2)});
    EXPECT_NEAR(map.Clearance(0, {x, 1}), 1, 1e-6);
  }
}

TEST(GroundMap, GapsAndHolesReduceTheClearance) {
  // A ring of four bars about a square hole of 1 m, and a slit of 1 mm beside it.
  const GroundMap map = Map({Ground(-1, 0, 0, 1, 3), Ground(1, 0, 0, 1, 3), Ground(0, 1, 0, 1, 1),
                             Ground(0, -1, 0, 1, 1), Ground(2.001, 0, 0, 1, 3)});
  EXPECT_NEAR(map.Clearance(0, {0, 0}), -0.5, 1e-6);
  EXPECT_NEAR(map.Clearance(0, {0.8, 0}), 0.3, 1e-6);
  EXPECT_NEAR(map.Clearance(0, {0, 1.1}), 0.4, 1e-6);
  EXPECT_NEAR(map.Clearance(0, {1.5005, 0.3}), -0.0005, 1e-6);
  EXPECT_NEAR(map.Clearance(0, {1.3, 0}), 0.2, 1e-6);
  EXPECT_NEAR(map.Clearance(0, {1.7, 0}), 0.199, 1e-6);
}

TEST(GroundMap, LevelsAreSortedMergedAndFound) {
  const GroundMap map = Map({Ground(0, 0, 0.5, 2, 2), Ground(0, 0, 0, 10, 10),
                             Ground(0.5, 0, 0.2, 4, 4), Ground(3, 0, 0.5 + 5e-7, 4, 2)});
  ASSERT_EQ(map.levels().size(), 3u);
  EXPECT_NEAR(map.levels()[0], 0, 1e-12);
  EXPECT_NEAR(map.levels()[1], 0.2, 1e-12);
  EXPECT_NEAR(map.levels()[2], 0.5, 1e-6);
  EXPECT_NEAR(map.Clearance(2, {1, 0}), 1, 2e-6);
  EXPECT_EQ(map.LevelAt({0, 0}, 0.19, 0.02), 1);
  EXPECT_EQ(map.LevelAt({0, 0}, 0.3, 1), 2);
  EXPECT_EQ(map.LevelAt({-3, 0}, 0.3, 1), 0);
  EXPECT_EQ(map.LevelAt({0, 0}, 0.3, 0.05), std::nullopt);
  EXPECT_EQ(map.LevelBelow({0, 0}, 0.4995), 2);
  EXPECT_EQ(map.LevelBelow({0, 0}, 0.498), 1);
  EXPECT_EQ(map.LevelBelow({-4, 0}, 2), 0);
  EXPECT_EQ(map.LevelBelow({-6, 0}, 2), std::nullopt);
  EXPECT_EQ(map.LevelBelow({0, 0}, -0.01), std::nullopt);
  EXPECT_THROW(map.Clearance(3, {0, 0}), std::out_of_range);
  EXPECT_THROW(map.Clearance(-1, {0, 0}), std::out_of_range);
}

TEST(GroundMap, ObstaclesThatAreNoGroundHaveNoLevel) {
  Obstacle wall = Ground(0, 0, 2, 1, 1);
  wall.is_ground = false;
  Obstacle ball{"ball", Shape::Sphere(1), Isometry3d::Identity(), false};
  EXPECT_TRUE(Map({wall, ball}).levels().empty());
  EXPECT_EQ(Map({wall, ball}).LevelBelow({0, 0}, 9), std::nullopt);
}

TEST(GroundMap, PointThatIsNotFiniteHasNoGround) {
  const GroundMap map = Map({Ground(0, 0, 0, 1, 1)});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(map.LevelAt({nan, 0}, 0, 1), std::nullopt);
  EXPECT_EQ(map.LevelBelow({0, nan}, 1), std::nullopt);
}

TEST(GroundMap, RefusesGroundWithoutASideThatFacesUp) {
  const Obstacle drum{"drum", Shape::Cylinder(1, 1), Isometry3d::Identity(), true};
  EXPECT_THROW(Map({drum}), InputError);
  Obstacle lost = Ground(0, 0, 0, 1, 1);
  lost.X_WO.translation().x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(Map({lost}), InputError);
  Obstacle on_a_corner = Ground(0, 0, 0, 1, 1);
  on_a_corner.name = "die";
  on_a_corner.X_WO.linear() =
      SmallestRotation(Vector3d(1, 1, 1), Vector3d::UnitZ()).toRotationMatrix();
  try {
    Map({on_a_corner});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("die"), std::string::npos);
  }
}

TEST(GroundMap, RefusesFacesThatAreNoPolygonsOfAPlane) {
  const auto refuses = [](std::vector<Vector3d> corners) {
    Environment environment;
    environment.faces.push_back({"patch", std::move(corners)});
    try {
      GroundMap map(environment);
    } catch (const InputError& error) {
      return std::string(error.what()).find("patch") != std::string::npos;
    }
    return false;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(refuses({{0, 0, 0}, {1, 0, 0}, {1, 1, 0.5}}));
  EXPECT_TRUE(refuses({{0, 0, 0}, {1, 0, 0}}));
  EXPECT_TRUE(refuses({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}));
  EXPECT_TRUE(refuses({{0, 0, 0}, {1, 0, 0}, {1, 1, nan}}));
  EXPECT_TRUE(refuses({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0.01}}));
  EXPECT_TRUE(refuses({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}}));    // faces down
  EXPECT_TRUE(refuses({{0, 0, 0}, {1, 0, 0}, {1, 1, 1.5}}));  // too steep
}

/// A tilted box, and where its side that faces up most lies.
struct Board {
  Obstacle box{"board", Shape::Box({1, 1, 1}), Isometry3d::Identity(), true};
  int axis = 2;
  double side = 1;

  explicit Board(RandomGeometry* random) {
    box.shape.size =
        Vector3d(random->Uniform(0.3, 2), random->Uniform(0.3, 2), random->Uniform(0.3, 2));
    // One of the six sides upwards, then turned and tilted.
    const Vector3d tilt_axis =
        Vector3d(random->Uniform(-1, 1), random->Uniform(-1, 1), 0.0).normalized();
    const Eigen::Matrix3d tilt =
        AngleAxisd(random->Uniform(0.01, 0.7), tilt_axis).toRotationMatrix();
    const Eigen::Matrix3d turn =
        AngleAxisd(random->Uniform(-3, 3), Vector3d::UnitZ()).toRotationMatrix();
    axis = static_cast<int>(random->Uniform(0, 2.999));
    side = random->Uniform(-1, 1) < 0 ? -1 : 1;
    const Eigen::Matrix3d rolled =
        SmallestRotation(side * Vector3d::Unit(axis), Vector3d::UnitZ()).toRotationMatrix();
    box.X_WO.linear() = tilt * turn * rolled;
    box.X_WO.translation() = Vector3d(random->Uniform(-1, 1), random->Uniform(-1, 1), 0.3);
  }

  /// Signed distance in the plane of the side from the point of it above or below p.
  double Clearance(const Vector2d& p) const {
    const Vector3d normal = side * box.X_WO.linear().col(axis);
    const Vector3d middle =
        box.X_WO * Vector3d(side * box.shape.size[axis] / 2 * Vector3d::Unit(axis));
    const double z = middle.z() - normal.head<2>().dot(p - middle.head<2>()) / normal.z();
    const Vector3d local = box.X_WO.inverse() * Vector3d(p.x(), p.y(), z);
    Eigen::Array2d outside;
    for (int i = 0; i < 2; ++i) {
      const int across = (axis + 1 + i) % 3;
      outside[i] = std::abs(local[across]) - box.shape.size[across] / 2;
    }
    return outside.maxCoeff() > 0 ? -outside.max(0).matrix().norm() : -outside.maxCoeff();
  }
};

TEST(GroundMap, TheSideOfABoxThatFacesUpIsGround) {
  RandomGeometry random(7);
  for (int trial = 0; trial < 200; ++trial) {
    const Board board(&random);
    const GroundMap map = Map({board.box});
    ASSERT_EQ(map.planes().size(), 1u);
    EXPECT_TRUE(map.levels().empty());
    const Vector3d up = board.side * board.box.X_WO.linear().col(board.axis);
    EXPECT_LT((map.planes()[0].normal - up).norm(), 1e-12);
    for (int sample = 0; sample < 40; ++sample) {
      const Vector2d p(random.Uniform(-2, 2), random.Uniform(-2, 2));
      const double clearance = board.Clearance(p);
      EXPECT_NEAR(map.Clearance(0, p), clearance, 1e-6);
      const double z = map.planes()[0].HeightAt(p);
      EXPECT_EQ(map.PlanesAt(p, z - 1e-3, z + 1e-3).size(), clearance > 0 ? 1u : 0u);
      EXPECT_TRUE(map.PlanesAt(p, z + 1e-3, z + 1).empty());
      const auto below = map.HeightBelow(p, z + 0.2);
      ASSERT_EQ(below.has_value(), clearance > 0);
      EXPECT_NEAR(below.value_or(z), z, 1e-9);
      EXPECT_FALSE(map.HeightBelow(p, z - 0.01).has_value());
    }
  }
}

TEST(GroundMap, GroundThatIsMoreSlipperyThanTheRobotIsNoLevel) {
  Environment environment;
  environment.obstacles = {Ground(0, 0, 0, 2, 2), Ground(2, 0, 0, 2, 2), Ground(4, 0, 0, 2, 2)};
  environment.obstacles[1].friction = 0.2;
  environment.obstacles[2].friction = 0.9;
  const GroundMap map(environment, 0.6);
  ASSERT_EQ(map.levels().size(), 1u);
  ASSERT_EQ(map.planes().size(), 2u);
  EXPECT_GE(map.planes()[0].friction, 0.6);
  EXPECT_EQ(map.planes()[1].friction, 0.2);
  RandomGeometry random(12);
  for (int trial = 0; trial < 500; ++trial) {
    const double x = random.Uniform(-1, 5);
    const std::vector<int> expected = {std::abs(x - 2) < 1 ? 1 : 0};
    EXPECT_EQ(map.PlanesAt({x, random.Uniform(-1, 1)}, -0.1, 0.1), expected) << x;
  }
  EXPECT_FALSE(map.LevelAt({2, 0}, 0, 1e-3));
  EXPECT_EQ(map.HeightBelow({2, 0}, 1), 0);
}

TEST(GroundMap, WithoutARobotsFrictionTheLeastOfALevelCounts) {
  Environment environment;
  environment.obstacles = {Ground(0, 0, 0, 2, 2), Ground(2, 0, 0, 2, 2)};
  environment.obstacles[1].friction = 0.2;
  const GroundMap map(environment);
  ASSERT_EQ(map.planes().size(), 1u);
  EXPECT_EQ(map.planes()[0].friction, 0.2);
}

TEST(GroundMap, AnObstacleThatBearsIsNoLevel) {
  Environment environment;
  environment.obstacles = {Ground(0, 0, 0, 2, 2), Ground(0, 0, 0.3, 0.5, 0.5)};
  environment.obstacles[1].is_for_steps = true;
  const GroundMap map(environment, 0.6);
  ASSERT_EQ(map.levels(), std::vector<double>{0});
  ASSERT_EQ(map.planes().size(), 2u);
  EXPECT_EQ(map.HeightBelow({0.2, 0.2}, 1), 0.3);
  EXPECT_TRUE(map.RoughGroundIsNear({0, 0, 0.4}, 0.11));
  EXPECT_FALSE(map.RoughGroundIsNear({0, 0, 0.4}, 0.09));
}

TEST(GroundMap, PlanesNearHoldEveryPlaneWithAPointThatIsNear) {
  RandomGeometry random(13);
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<Obstacle> boxes;
    for (int i = 0; i < 12; ++i) {
      boxes.push_back(Ground(random.Uniform(-3, 3), random.Uniform(-3, 3), random.Uniform(-1, 1),
                             random.Uniform(0.1, 2), random.Uniform(0.1, 2)));
      if (i % 2 > 0)
        boxes.back().X_WO.rotate(AngleAxisd(random.Uniform(0, 0.7), Vector3d::UnitX()));
    }
    const GroundMap map = Map(boxes);
    const Vector3d p(random.Uniform(-2, 2), random.Uniform(-2, 2), random.Uniform(-1, 1));
    const double distance = random.Uniform(0, 1);
    const std::vector<int> near = map.PlanesNear(p, distance);
    EXPECT_TRUE(std::is_sorted(near.begin(), near.end()));
    for (int sample = 0; sample < 200; ++sample) {
      const Vector3d offset(random.Uniform(-1, 1), random.Uniform(-1, 1), 0);
      const Vector2d there = p.head<2>() + distance * offset.head<2>();
      for (const int plane : map.PlanesAt(there, p.z() - distance, p.z() + distance)) {
        const Vector3d on(there.x(), there.y(), map.planes()[plane].HeightAt(there));
        if ((on - p).norm() > distance) continue;
        EXPECT_TRUE(std::binary_search(near.begin(), near.end(), plane));
      }
    }
  }
}

TEST(GroundMap, RoughGroundIsNearAgreesWithTheNearestPointOfASample) {
  RandomGeometry random(8);
  for (int trial = 0; trial < 20; ++trial) {
    const Board board(&random);
    const GroundMap map = Map({board.box});
    for (int sample = 0; sample < 20; ++sample) {
      const Vector3d p(random.Uniform(-2, 2), random.Uniform(-2, 2), random.Uniform(-1, 2));
      double nearest = std::numeric_limits<double>::infinity();
      constexpr int kSteps = 60;
      for (int i = 0; i <= kSteps; ++i) {
        for (int j = 0; j <= kSteps; ++j) {
          Vector3d local = Vector3d::Zero();
          local[board.axis] = board.side * board.box.shape.size[board.axis] / 2;
          const int a = (board.axis + 1) % 3, b = (board.axis + 2) % 3;
          local[a] = (static_cast<double>(i) / kSteps - 0.5) * board.box.shape.size[a];
          local[b] = (static_cast<double>(j) / kSteps - 0.5) * board.box.shape.size[b];
          nearest = std::min(nearest, (board.box.X_WO * local - p).norm());
        }
      }
      EXPECT_TRUE(map.RoughGroundIsNear(p, nearest + 1e-6));
      EXPECT_FALSE(map.RoughGroundIsNear(p, nearest - 0.03));  // a sample's spacing
    }
  }
}

TEST(GroundMap, PolygonsOfAPlaneHaveNoSeam) {
  RandomGeometry random(9);
  for (int trial = 0; trial < 50; ++trial) {
    // A tilted square as a fan of triangles about a random inner point.
    const Isometry3d X_WP = Isometry3d(
        Eigen::Translation3d(random.Uniform(-1, 1), random.Uniform(-1, 1), random.Uniform(-1, 1)) *
        AngleAxisd(random.Uniform(-3, 3), Vector3d::UnitZ()) *
        AngleAxisd(trial % 2 == 0 ? 0 : random.Uniform(0.05, 0.7), Vector3d::UnitX()));
    const Vector3d corners[] = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    const Vector3d middle(random.Uniform(-0.99, 0.99), random.Uniform(-0.99, 0.99), 0);
    Environment environment;
    for (int i = 0; i < 4; ++i) {
      environment.faces.push_back(
          {"fan", {X_WP * corners[i], X_WP * corners[(i + 1) % 4], X_WP * middle}});
    }
    const GroundMap map(environment);
    ASSERT_EQ(map.planes().size(), 1u);
    EXPECT_EQ(map.levels().size(), trial % 2 == 0 ? 1u : 0u);
    for (int sample = 0; sample < 40; ++sample) {
      const Vector2d inside(random.Uniform(-1.5, 1.5), random.Uniform(-1.5, 1.5));
      const Vector3d p = X_WP * Vector3d(inside.x(), inside.y(), 0);
      const Eigen::Array2d outside = inside.array().abs() - 1;
      const double clearance =
          outside.maxCoeff() > 0 ? -outside.max(0).matrix().norm() : -outside.maxCoeff();
      EXPECT_NEAR(map.Clearance(0, p.head<2>()), clearance, 1e-6);
    }
  }
}

}  // namespace
}  // namespace possibility::models
