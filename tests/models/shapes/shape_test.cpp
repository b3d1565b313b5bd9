#include "models/shapes/shape.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "models/input/input_error.h"
#include "tests/models/random_geometry.h"

namespace possibility::models {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using testing::RandomGeometry;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// A point of the shape, on its surface or inside.
Vector3d AnyPoint(const Shape& shape, RandomGeometry* random) {
  const double share = random->Index(3) == 0 ? random->Uniform(0, 1) : 1;
  const double along = random->Uniform(-0.5, 0.5) * shape.length;
  switch (shape.type) {
    case ShapeType::kBox: {
      Vector3d p(random->Uniform(-0.5, 0.5), random->Uniform(-0.5, 0.5),
                 random->Uniform(-0.5, 0.5));
      if (share == 1) p[random->Index(3)] = 0.5;
      return p.cwiseProduct(shape.size);
    }
    case ShapeType::kSphere:
      return share * shape.radius * random->Direction();
    case ShapeType::kCylinder: {
      const double angle = random->Uniform(0, 7);
      const double height = random->Index(2) == 0 ? along : 0.5 * shape.length;
      return {share * shape.radius * std::cos(angle), share * shape.radius * std::sin(angle),
              height};
    }
    case ShapeType::kCapsule:
      return Vector3d(0, 0, random->Index(2) == 0 ? along : 0.5 * shape.length) +
             share * shape.radius * random->Direction();
    case ShapeType::kConvexMesh:
      break;
  }
  const int count = static_cast<int>(shape.vertices.size());
  return (1 - share) * shape.vertices[random->Index(count)] +
         share * shape.vertices[random->Index(count)];
}

/// How far a point is outside the shape, by the shape's defining inequalities. For a mesh: the
/// distance from the nearest vertex, where support points must lie.
double Violation(const Shape& shape, const Vector3d& p) {
  const double beyond_ends = std::abs(p.z()) - shape.length / 2;
  switch (shape.type) {
    case ShapeType::kBox:
      return (p.cwiseAbs() - shape.size / 2).maxCoeff();
    case ShapeType::kSphere:
      return p.norm() - shape.radius;
    case ShapeType::kCylinder:
      return std::max(p.head<2>().norm() - shape.radius, beyond_ends);
    case ShapeType::kCapsule:
      return std::hypot(p.head<2>().norm(), std::max(beyond_ends, 0.0)) - shape.radius;
    case ShapeType::kConvexMesh:
      break;
  }
  double nearest = 1e9;
  for (const Vector3d& vertex : shape.vertices) nearest = std::min(nearest, (p - vertex).norm());
  return nearest;
}

TEST(Shape, SupportLiesInTheShapeAndNoPointLiesBeyondIt) {
  RandomGeometry random(1);
  for (int trial = 0; trial < 2000; ++trial) {
    const Shape shape = random.AnyShape();
    Vector3d direction = random.Uniform(0.1, 3) * random.Direction();
    if (trial % 5 == 0) direction = Vector3d::Unit(random.Index(3));
    const Vector3d support = shape.Support(direction);
    EXPECT_LE(Violation(shape, support), 1e-12);
    for (int i = 0; i < 50; ++i) {
      EXPECT_LE(direction.dot(AnyPoint(shape, &random)), direction.dot(support) + 1e-12);
    }
  }
}

TEST(Shape, SupportAlongNoDirectionIsAPointOfTheShape) {
  RandomGeometry random(2);
  for (int trial = 0; trial < 100; ++trial) {
    const Shape shape = random.AnyShape();
    EXPECT_LE(Violation(shape, shape.Support(Vector3d::Zero())), 1e-12);
  }
}

TEST(Shape, BoundsAreTight) {
  RandomGeometry random(3);
  for (int trial = 0; trial < 2000; ++trial) {
    const Shape shape = random.AnyShape();
    const Isometry3d X = random.Pose(5);
    Vector3d reach = Vector3d::Zero();
    Vector3d centre = X.translation();
    const Vector3d axis = X.linear().col(2).cwiseAbs();
    switch (shape.type) {
      case ShapeType::kBox:
        reach = X.linear().cwiseAbs() * shape.size / 2;
        break;
      case ShapeType::kSphere:
        reach = Vector3d::Constant(shape.radius);
        break;
      case ShapeType::kCapsule:
        reach = Vector3d::Constant(shape.radius) + shape.length / 2 * axis;
        break;
      case ShapeType::kCylinder:
        reach = shape.radius * (1 - axis.array().square()).max(0).sqrt().matrix() +
                shape.length / 2 * axis;
        break;
      case ShapeType::kConvexMesh: {
        Eigen::AlignedBox3d hull;
        for (const Vector3d& vertex : shape.vertices) hull.extend(X * vertex);
        reach = hull.sizes() / 2;
        centre = hull.center();
        break;
      }
    }
    const Eigen::AlignedBox3d bounds = shape.Bounds(X);
    EXPECT_LT((bounds.max() - centre - reach).norm(), 1e-9);
    EXPECT_LT((bounds.min() - centre + reach).norm(), 1e-9);
  }
}

TEST(Shape, FactoriesRefuseInvalidDimensions) {
  EXPECT_THROW(Shape::Box({1, 0, 1}), InputError);
  EXPECT_THROW(Shape::Box({1, 1, kNaN}), InputError);
  EXPECT_THROW(Shape::Sphere(-1), InputError);
  EXPECT_THROW(Shape::Sphere(std::numeric_limits<double>::infinity()), InputError);
  EXPECT_THROW(Shape::Cylinder(0.1, 0), InputError);
  EXPECT_THROW(Shape::Capsule(0.1, -0.1), InputError);
  EXPECT_NO_THROW(Shape::Capsule(0.1, 0));
  EXPECT_THROW(Shape::ConvexMesh({}), InputError);
  EXPECT_THROW(Shape::ConvexMesh({{0, 0, kNaN}}), InputError);
}

}  // namespace
}  // namespace possibility::models
