#include "models/shapes/upright_boxes.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "models/shapes/signed_distance.h"
#include "models/world/collision.h"
#include "tests/models/random_geometry.h"

namespace possibility::models {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Isometry3d;
using Eigen::Vector3d;
using testing::RandomGeometry;

Environment RandomScene(int count, RandomGeometry* random) {
  Environment environment;
  Isometry3d X_floor = Isometry3d::Identity();
  X_floor.translation().z() = -0.05;
  environment.obstacles.push_back({"floor", Shape::Box({20, 20, 0.1}), X_floor, true});
  for (int i = 0; i < count; ++i) {
    Isometry3d X = i % 2 == 0 ? random->Pose(2) : random->UprightPose(2);
    X.translation().z() = random->Uniform(0, 1.5);
    environment.obstacles.push_back({std::to_string(i), random->AnyShape(2), X, false});
  }
  return environment;
}

/// Random boxes, some of them just above the floor.
UprightBoxes RandomBoxes(RandomGeometry* random) {
  std::vector<AlignedBox3d> boxes;
  for (int i = random->Index(4); i >= 0; --i) {
    const Vector3d low(random->Uniform(-0.6, 0), random->Uniform(-0.6, 0),
                       random->Uniform(0, 1) < 0.5 ? 0.001 : random->Uniform(0, 1));
    const Vector3d size(random->Uniform(0.1, 0.8), random->Uniform(0.1, 0.8),
                        random->Uniform(0.1, 0.8));
    boxes.emplace_back(low, low + size);
  }
  return UprightBoxes(boxes);
}

Isometry3d RandomStance(RandomGeometry* random) {
  Isometry3d X = random->UprightPose(2);
  X.translation().z() = random->Uniform(0, 1) < 0.7 ? 0 : random->Uniform(-0.1, 0.2);
  return X;
}

TEST(UprightBoxes, AreFreeExactlyIfEachBoxIs) {
  RandomGeometry random(11);
  int free = 0;
  int blocked = 0;
  for (const int count : {0, 3, 15, 60}) {
    for (int scene = 0; scene < 12; ++scene) {
      const CollisionChecker checker(RandomScene(count, &random));
      const UprightBoxes boxes = RandomBoxes(&random);
      for (int trial = 0; trial < 60; ++trial) {
        const Isometry3d X_WS = RandomStance(&random);
        bool each_is_free = true;
        for (size_t i = 0; i < boxes.shapes().size(); ++i) {
          each_is_free =
              each_is_free && checker.IsFree(boxes.shapes()[i], X_WS * boxes.X_SB()[i], 0);
        }
        EXPECT_EQ(checker.AreFree(boxes, X_WS), each_is_free);
        ++(each_is_free ? free : blocked);
      }
    }
  }
  EXPECT_GT(free, 300);
  EXPECT_GT(blocked, 300);
}

TEST(UprightBoxes, TouchingIsNotFree) {
  Environment environment;
  environment.obstacles.push_back({"block", Shape::Box({1, 1, 1}), Isometry3d::Identity(), false});
  const CollisionChecker checker(environment);
  const UprightBoxes boxes({AlignedBox3d(Vector3d(-0.5, -0.5, -0.5), Vector3d(0.5, 0.5, 0.5))});
  Isometry3d X_WS = Isometry3d::Identity();
  X_WS.translation().x() = 1;
  EXPECT_FALSE(checker.AreFree(boxes, X_WS));
  X_WS.translation().x() = 1 + 1e-6;
  EXPECT_TRUE(checker.AreFree(boxes, X_WS));
  EXPECT_FALSE(checker.AreCertainlyFree({Prism(boxes.boxes()[0], X_WS)}));
  X_WS.translation().x() = 1 + 2e-4;
  EXPECT_TRUE(checker.AreCertainlyFree({Prism(boxes.boxes()[0], X_WS)}));
}

TEST(UprightBoxes, CertainlyFreeBoxesKeepTheirDistance) {
  RandomGeometry random(12);
  int certain = 0;
  for (int scene = 0; scene < 40; ++scene) {
    const CollisionChecker checker(RandomScene(20, &random));
    for (int trial = 0; trial < 100; ++trial) {
      const UprightBoxes boxes = RandomBoxes(&random);
      const Isometry3d X_WS = RandomStance(&random);
      std::vector<Prism> prisms;
      for (const AlignedBox3d& box : boxes.boxes()) prisms.emplace_back(box, X_WS);
      if (!checker.AreCertainlyFree(prisms)) continue;
      ++certain;
      for (size_t i = 0; i < boxes.shapes().size(); ++i) {
        EXPECT_GE(checker.Clearance(boxes.shapes()[i], X_WS * boxes.X_SB()[i], 1), 0.5e-4);
      }
    }
  }
  EXPECT_GT(certain, 500);
}

TEST(UprightBoxes, PrismsAreApartExactlyWhereTheDistanceIsPositive) {
  // The distance of two upright boxes is positive exactly if their prisms are apart.
  RandomGeometry random(13);
  for (int trial = 0; trial < 2000; ++trial) {
    const Vector3d size_a(random.Uniform(0.1, 1), random.Uniform(0.1, 1), random.Uniform(0.1, 1));
    const Vector3d size_b(random.Uniform(0.1, 1), random.Uniform(0.1, 1), random.Uniform(0.1, 1));
    const Isometry3d X_WA = random.UprightPose(0.6);
    const Isometry3d X_WB = random.UprightPose(0.6);
    const PreparedShape A(Shape::Box(size_a)), B(Shape::Box(size_b));
    const double distance = SignedDistance(A, X_WA, B, X_WB, 10);
    const Prism a(AlignedBox3d(-size_a / 2, size_a / 2), X_WA);
    const Prism b(B, X_WB, B.OuterBounds(X_WB));
    EXPECT_EQ(AreApart(a, b, 0), distance > 0) << distance;
  }
}

TEST(UprightBoxes, PosesThatAreNotFiniteAreNotFree) {
  RandomGeometry random(14);
  const CollisionChecker checker(RandomScene(1, &random));
  const UprightBoxes boxes = RandomBoxes(&random);
  Isometry3d X_WS = Isometry3d::Identity();
  X_WS.translation().x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(checker.AreFree(boxes, X_WS));
  EXPECT_FALSE(checker.AreCertainlyFree({Prism(boxes.boxes()[0], X_WS)}));
}

}  // namespace
}  // namespace possibility::models
