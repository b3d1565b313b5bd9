#include "models/shapes/shape.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "models/input/input_error.h"

namespace possibility::models {
namespace {

using Eigen::Vector3d;

double Checked(double value, bool may_be_zero, const char* what) {
  const bool valid = std::isfinite(value) && (may_be_zero ? value >= 0 : value > 0);
  if (!valid) {
    throw InputError(fmt::format("{} is {}, expected a finite {} number of metres", what, value,
                                 may_be_zero ? "non-negative" : "positive"));
  }
  return value;
}

/// The point of the ball of this radius farthest along `direction`.
Vector3d BallSupport(double radius, const Vector3d& direction) {
  const double norm = direction.norm();
  return norm > 0 ? Vector3d(direction * (radius / norm)) : Vector3d(radius, 0, 0);
}

Vector3d CylinderSupport(double radius, double length, const Vector3d& direction) {
  const double norm = direction.head<2>().norm();
  const Eigen::Vector2d rim = norm > 0 ? Eigen::Vector2d(direction.head<2>() * (radius / norm))
                                       : Eigen::Vector2d(radius, 0);
  return {rim.x(), rim.y(), std::copysign(length / 2, direction.z())};
}

Vector3d VertexSupport(const std::vector<Vector3d>& vertices, const Vector3d& direction) {
  Vector3d farthest = Vector3d::Zero();
  double extent = -std::numeric_limits<double>::infinity();
  for (const Vector3d& vertex : vertices) {
    if (const double along = direction.dot(vertex); along > extent) {
      extent = along;
      farthest = vertex;
    }
  }
  return farthest;
}

}  // namespace

Shape Shape::Box(const Vector3d& size) {
  Shape shape;
  shape.type = ShapeType::kBox;
  for (int i = 0; i < 3; ++i) shape.size[i] = Checked(size[i], false, "box: extent");
  return shape;
}

Shape Shape::Sphere(double radius) {
  Shape shape;
  shape.type = ShapeType::kSphere;
  shape.radius = Checked(radius, false, "sphere: radius");
  return shape;
}

Shape Shape::Cylinder(double radius, double length) {
  Shape shape;
  shape.type = ShapeType::kCylinder;
  shape.radius = Checked(radius, false, "cylinder: radius");
  shape.length = Checked(length, false, "cylinder: length");
  return shape;
}

Shape Shape::Capsule(double radius, double length) {
  Shape shape;
  shape.type = ShapeType::kCapsule;
  shape.radius = Checked(radius, false, "capsule: radius");
  shape.length = Checked(length, true, "capsule: length");
  return shape;
}

Shape Shape::ConvexMesh(std::vector<Vector3d> vertices) {
  if (vertices.empty()) throw InputError("convex mesh: no vertices, expected at least one");
  const auto is_finite = [](const Vector3d& vertex) { return vertex.allFinite(); };
  if (!std::all_of(vertices.begin(), vertices.end(), is_finite)) {
    throw InputError("convex mesh: a vertex is not finite, expected numbers of metres");
  }
  Shape shape;
  shape.type = ShapeType::kConvexMesh;
  shape.vertices = std::move(vertices);
  return shape;
}

Vector3d Shape::Support(const Vector3d& direction) const {
  switch (type) {
    case ShapeType::kBox:
      return size.binaryExpr(
          direction, [](double extent, double along) { return std::copysign(extent / 2, along); });
    case ShapeType::kSphere:
      return BallSupport(radius, direction);
    case ShapeType::kCylinder:
      return CylinderSupport(radius, length, direction);
    case ShapeType::kCapsule:
      return BallSupport(radius, direction) +
             Vector3d(0, 0, std::copysign(length / 2, direction.z()));
    case ShapeType::kConvexMesh:
      break;
  }
  return VertexSupport(vertices, direction);
}

Eigen::AlignedBox3d Shape::Bounds(const Eigen::Isometry3d& X_WS) const {
  Eigen::AlignedBox3d bounds;
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3d direction_S = X_WS.linear().row(axis);
    bounds.max()[axis] = (X_WS * Support(direction_S))[axis];
    bounds.min()[axis] = (X_WS * Support(-direction_S))[axis];
  }
  return bounds;
}

}  // namespace possibility::models
