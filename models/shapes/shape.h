#pragma once

#include <Eigen/Geometry>
#include <vector>

namespace possibility::models {

enum class ShapeType { kBox, kSphere, kCylinder, kCapsule, kConvexMesh };

/// A convex collision shape in its own frame S (lengths in metres).
struct Shape {
  ShapeType type = ShapeType::kBox;
  /// kBox: full extents along x, y, z. Unused otherwise.
  Eigen::Vector3d size = Eigen::Vector3d::Zero();
  /// kSphere, kCylinder, kCapsule.
  double radius = 0;
  /// kCylinder: height along z. kCapsule: distance between the two sphere centres along z.
  double length = 0;
  /// kConvexMesh: the points whose convex hull is the shape.
  std::vector<Eigen::Vector3d> vertices;

  static Shape Box(const Eigen::Vector3d& size);
  static Shape Sphere(double radius);
  static Shape Cylinder(double radius, double length);
  static Shape Capsule(double radius, double length);
  static Shape ConvexMesh(std::vector<Eigen::Vector3d> vertices);

  /// Support point: the point of the shape farthest along `direction` (frame S).
  Eigen::Vector3d Support(const Eigen::Vector3d& direction) const;

  /// Axis-aligned bounds of the shape posed at X_WS, in W.
  Eigen::AlignedBox3d Bounds(const Eigen::Isometry3d& X_WS) const;
};

/// A shape with its place in a parent frame P.
struct PosedShape {
  Shape shape;
  Eigen::Isometry3d X_PS = Eigen::Isometry3d::Identity();
};

}  // namespace possibility::models
