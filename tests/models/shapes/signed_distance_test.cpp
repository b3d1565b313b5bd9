#include "models/shapes/signed_distance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "models/input/input_error.h"
#include "tests/models/random_geometry.h"

namespace possibility::models {
namespace {

using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Vector3d;
using testing::RandomGeometry;

constexpr double kFar = 1e9;
constexpr double kTolerance = 5e-5;

double Distance(const Shape& a, const Isometry3d& X_WA, const Shape& b, const Isometry3d& X_WB,
                double enough = kFar) {
  const PreparedShape A(a), B(b);
  return SignedDistance(A, A.CorePose(X_WA), B, B.CorePose(X_WB), enough);
}

Isometry3d At(double x, double y, double z) {
  Isometry3d X = Isometry3d::Identity();
  X.translation() = Vector3d(x, y, z);
  return X;
}

Isometry3d At(double x, double y, double z, double angle, const Vector3d& axis) {
  return At(x, y, z) * AngleAxisd(angle, axis.normalized());
}

/// Gap between the supporting planes normal to `n`.
double GapAlong(const Shape& a, const Isometry3d& X_WA, const Shape& b, const Isometry3d& X_WB,
                const Vector3d& n) {
  const Vector3d on_a = X_WA * a.Support(X_WA.linear().transpose() * n);
  const Vector3d on_b = X_WB * b.Support(X_WB.linear().transpose() * -n);
  return n.dot(on_b - on_a);
}

/// The signed distance as the largest gap over all directions: dense sampling, then pattern search
/// from the best samples.
double SlowDistance(const Shape& a, const Isometry3d& X_WA, const Shape& b,
                    const Isometry3d& X_WB) {
  constexpr int kSamples = 800;
  std::array<std::pair<double, Vector3d>, kSamples> samples;
  for (int i = 0; i < kSamples; ++i) {
    const double z = 1 - (2 * i + 1.0) / kSamples;
    const double angle = 2.399963 * i;
    const Vector3d n(std::sqrt(1 - z * z) * std::cos(angle), std::sqrt(1 - z * z) * std::sin(angle),
                     z);
    samples[i] = {GapAlong(a, X_WA, b, X_WB, n), n};
  }
  constexpr int kStarts = 6;
  std::partial_sort(samples.begin(), samples.begin() + kStarts, samples.end(),
                    [](const auto& x, const auto& y) { return x.first > y.first; });
  double best = -kFar;
  for (int start = 0; start < kStarts; ++start) {
    auto [gap, n] = samples[start];
    for (double step = 0.05; step > 1e-6;) {
      const Vector3d u = n.unitOrthogonal(), v = n.cross(u);
      bool improved = false;
      for (int k = 0; k < 12 && !improved; ++k) {
        const double angle = k * 0.5236;
        const Vector3d m = (n + step * (std::cos(angle) * u + std::sin(angle) * v)).normalized();
        if (const double other = GapAlong(a, X_WA, b, X_WB, m); other > gap) {
          gap = other;
          n = m;
          improved = true;
        }
      }
      if (!improved) step /= 2;
    }
    best = std::max(best, gap);
  }
  return best;
}

TEST(SignedDistance, BoxesHaveClosedForms) {
  const Shape unit = Shape::Box({1, 1, 1});
  const Vector3d z = Vector3d::UnitZ();
  const double half_diagonal = std::sqrt(0.5);
  // Face to face, apart and overlapping.
  EXPECT_NEAR(Distance(unit, At(0, 0, 0), unit, At(1.25, 0.3, 0.2)), 0.25, 1e-9);
  EXPECT_NEAR(Distance(unit, At(0, 0, 0), unit, At(0.9, 0.3, 0.2)), -0.1, 1e-9);
  EXPECT_NEAR(Distance(unit, At(0, 0, 0), unit, At(0, 0, 0)), -1, 1e-9);
  // Edge to parallel edge, corner to corner.
  EXPECT_NEAR(Distance(unit, At(0, 0, 0), unit, At(1.3, 1.4, 0.1)), 0.5, 1e-9);
  EXPECT_NEAR(Distance(unit, At(0, 0, 0), unit, At(1.2, 1.3, 1.6)), 0.7, 1e-9);
  // A box turned by 45 degrees: edge to face.
  EXPECT_NEAR(Distance(unit, At(0, 0, 0), unit, At(1.5, 0, 0, M_PI / 4, z)), 1 - half_diagonal,
              1e-9);
  EXPECT_NEAR(Distance(unit, At(0, 0, 0), unit, At(1.1, 0, 0, M_PI / 4, z)), 0.6 - half_diagonal,
              1e-9);
  // Crossing edges: both boxes show an edge, at right angles.
  const Isometry3d lower = At(0, 0, 0, M_PI / 4, Vector3d::UnitX());
  for (const double gap : {0.3, 1e-6, 0.0, -1e-6, -0.05}) {
    const Isometry3d upper = At(0, 0, 2 * half_diagonal + gap, M_PI / 4, Vector3d::UnitY());
    EXPECT_NEAR(Distance(unit, lower, unit, upper), gap, 1e-9);
  }
}

TEST(SignedDistance, BallsAgainstBoxesHaveClosedForms) {
  RandomGeometry random(1);
  const Shape box = Shape::Box({20, 6, 0.4});
  for (int trial = 0; trial < 2000; ++trial) {
    const double radius = random.Uniform(0.02, 0.2);
    const Vector3d p(random.Uniform(-11, 11), random.Uniform(-4, 4), random.Uniform(-0.5, 0.5));
    const Vector3d outside = p.cwiseAbs() - Vector3d(10, 3, 0.2);
    const double centre_distance =
        outside.maxCoeff() > 0 ? outside.cwiseMax(0).norm() : outside.maxCoeff();
    const Isometry3d X = random.Pose(3);
    const Isometry3d X_ball = X * Eigen::Translation3d(p) * random.Rotation();
    EXPECT_NEAR(Distance(box, X, Shape::Sphere(radius), X_ball), centre_distance - radius, 1e-9);
    EXPECT_NEAR(Distance(Shape::Capsule(radius, 0), X_ball, box, X), centre_distance - radius,
                1e-9);
  }
}

TEST(SignedDistance, CapsuleOverAFloor) {
  RandomGeometry random(2);
  const Shape floor = Shape::Box({20, 20, 0.1});
  for (int trial = 0; trial < 3000; ++trial) {
    const double radius = random.Uniform(0.02, 0.1), length = random.Uniform(0.05, 0.3);
    Isometry3d X = random.Pose(9);
    X.translation().z() = random.Uniform(0.0, 0.4);
    const double lowest = X.translation().z() - length / 2 * std::abs(X.linear()(2, 2));
    // Deeper in, sideways is the shorter way out only near the floor's edge.
    EXPECT_NEAR(Distance(Shape::Capsule(radius, length), X, floor, At(0, 0, -0.05)),
                std::max(lowest, -0.1 - 2 * length) - radius, 1e-6)
        << trial;
  }
}

TEST(SignedDistance, SoleAtRestOnALargeFloor) {
  RandomGeometry random(3);
  const Shape floor = Shape::Box({20, 20, 0.1});
  double worst = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    const Shape sole = Shape::Box(
        {random.Uniform(0.1, 0.3), random.Uniform(0.05, 0.2), random.Uniform(0.01, 0.1)});
    const Isometry3d X_floor = random.UprightPose(trial % 2 == 0 ? 0.0 : 3.0);
    Isometry3d X = random.UprightPose(6);
    X.translation().z() = X_floor.translation().z() + 0.05 + sole.size.z() / 2;
    X.translation().head<2>() += X_floor.translation().head<2>();
    worst = std::max(worst, std::abs(Distance(sole, X, floor, X_floor)));
    // Nearly flat: the lowest corner decides.
    const Isometry3d tilted = X * AngleAxisd(random.Uniform(-1e-3, 1e-3), random.Direction());
    const double lowest = sole.Bounds(tilted).min().z() - X_floor.translation().z() - 0.05;
    if (X_floor.translation().norm() == 0) {
      worst = std::max(worst, std::abs(Distance(sole, tilted, floor, X_floor) - lowest));
    }
  }
  EXPECT_LT(worst, 1e-8);
}

/// Shapes placed so that supporting planes normal to a random direction lie `gap` apart and the
/// support points face each other: their distance is exactly the gap.
TEST(SignedDistance, ShapesFacingEachOtherAtAKnownDistance) {
  RandomGeometry random(4);
  for (int trial = 0; trial < 30000; ++trial) {
    const Shape a = random.AnyShape();
    const Shape b = random.AnyShape(trial % 3 == 0 ? 40 : 1);
    const Isometry3d X_WA = random.Pose(3);
    Isometry3d X_WB = random.Pose(3);
    Vector3d n = random.Direction();
    if (trial % 4 == 1) n = X_WA.linear().col(random.Index(3));
    if (trial % 4 == 2) n = X_WB.linear().col(random.Index(3));
    const double gap = trial % 5 == 0 ? 0 : std::pow(10, random.Uniform(-7, 0));
    const Vector3d on_a = X_WA * a.Support(X_WA.linear().transpose() * n);
    const Vector3d on_b = X_WB * b.Support(-X_WB.linear().transpose() * n);
    X_WB.translation() += on_a + gap * n - on_b;
    const double distance = Distance(a, X_WA, b, X_WB);
    EXPECT_LE(distance, gap + 1e-9);
    EXPECT_GE(distance, gap - kTolerance)
        << trial << " types " << static_cast<int>(a.type) << static_cast<int>(b.type);
  }
}

TEST(SignedDistance, AgreesWithDirectSearch) {
  RandomGeometry random(5);
  for (int trial = 0; trial < 600; ++trial) {
    const Shape a = random.AnyShape(static_cast<ShapeType>(trial % 5));
    const Shape b = random.AnyShape(static_cast<ShapeType>(trial / 5 % 5), trial % 2 == 0 ? 3 : 1);
    const Isometry3d X_WA = random.Pose(0.15);
    const Isometry3d X_WB = random.Pose(0.15);
    const double slow = SlowDistance(a, X_WA, b, X_WB);
    const double distance = Distance(a, X_WA, b, X_WB);
    // The search gets stuck on ridges, so it falls short by more than the tolerance of the
    // comparison.
    EXPECT_GE(distance, slow - kTolerance)
        << trial << " types " << static_cast<int>(a.type) << static_cast<int>(b.type);
    EXPECT_LE(distance, slow + 5e-3)
        << trial << " types " << static_cast<int>(a.type) << static_cast<int>(b.type);
  }
}

TEST(SignedDistance, IsSymmetricAndInvariantUnderRigidMotion) {
  RandomGeometry random(6);
  for (int trial = 0; trial < 5000; ++trial) {
    const Shape a = random.AnyShape(), b = random.AnyShape(2);
    const Isometry3d X_WA = random.Pose(0.3), X_WB = random.Pose(0.3), X_VW = random.Pose(10);
    const double distance = Distance(a, X_WA, b, X_WB);
    EXPECT_NEAR(Distance(a, X_VW * X_WA, b, X_VW * X_WB), distance, kTolerance);
    EXPECT_NEAR(Distance(b, X_WB, a, X_WA), distance, kTolerance);
  }
}

TEST(SignedDistance, DistancesBelowEnoughAreExact) {
  RandomGeometry random(7);
  for (int trial = 0; trial < 5000; ++trial) {
    const Shape a = random.AnyShape(), b = random.AnyShape();
    const Isometry3d X_WA = random.Pose(0.3), X_WB = random.Pose(0.3);
    const double full = Distance(a, X_WA, b, X_WB);
    const double enough = random.Uniform(-0.1, 0.3);
    const double short_cut = Distance(a, X_WA, b, X_WB, enough);
    EXPECT_LE(short_cut, full + 1e-6);
    if (full < enough - 1e-6) {
      EXPECT_NEAR(short_cut, full, 1e-12);
    }
    if (full > enough + kTolerance) {
      EXPECT_GE(short_cut, enough);
    }
  }
}

TEST(SignedDistance, PoseThatIsNotFiniteCollides) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  RandomGeometry random(8);
  for (int type = 0; type < 5; ++type) {
    const Shape shape = random.AnyShape(static_cast<ShapeType>(type));
    EXPECT_LT(Distance(shape, At(nan, 0, 0), Shape::Box({1, 1, 1}), At(9, 0, 0)), -1e100);
  }
}

TEST(PreparedShape, RefusesAMeshWithoutVertices) {
  Shape empty;
  empty.type = ShapeType::kConvexMesh;
  EXPECT_THROW(PreparedShape{empty}, InputError);
}

TEST(PreparedShape, OuterBoundsHoldTheShape) {
  RandomGeometry random(9);
  for (int trial = 0; trial < 2000; ++trial) {
    const Shape shape = random.AnyShape();
    const PreparedShape prepared(shape);
    const Isometry3d X = random.Pose(2);
    Eigen::AlignedBox3d outer = prepared.OuterBounds(prepared.CorePose(X));
    outer.min().array() -= 1e-12;
    outer.max().array() += 1e-12;
    EXPECT_TRUE(outer.contains(shape.Bounds(X)));
  }
}

}  // namespace
}  // namespace possibility::models
