#pragma once

#include <Eigen/Geometry>
#include <random>
#include <vector>

#include "models/shapes/shape.h"

namespace possibility::models::testing {

/// Random shapes and poses for property tests.
class RandomGeometry {
 public:
  explicit RandomGeometry(unsigned seed) : generator_(seed) {}

  double Uniform(double low, double high) {
    return std::uniform_real_distribution<>(low, high)(generator_);
  }

  int Index(int count) { return std::uniform_int_distribution<>(0, count - 1)(generator_); }

  Eigen::Vector3d Direction() {
    Eigen::Vector3d v;
    do {
      for (int i = 0; i < 3; ++i) v[i] = normal_(generator_);
    } while (v.norm() < 1e-3);
    return v.normalized();
  }

  Eigen::Quaterniond Rotation() {
    const Eigen::Vector3d axis = Direction();
    return Eigen::Quaterniond(Eigen::AngleAxisd(Uniform(0, 6.28), axis) *
                              Eigen::AngleAxisd(Uniform(0, 6.28), Direction()));
  }

  /// Position in a cube of half width `spread`, m.
  Eigen::Isometry3d Pose(double spread) {
    Eigen::Isometry3d X(Rotation());
    for (int i = 0; i < 3; ++i) X.translation()[i] = Uniform(-spread, spread);
    return X;
  }

  Eigen::Isometry3d UprightPose(double spread) {
    Eigen::Isometry3d X(Eigen::AngleAxisd(Uniform(-4, 4), Eigen::Vector3d::UnitZ()));
    for (int i = 0; i < 3; ++i) X.translation()[i] = Uniform(-spread, spread);
    return X;
  }

  /// A shape of the size of a robot link, times `scale`.
  Shape AnyShape(ShapeType type, double scale = 1) {
    const auto length = [&] { return scale * Uniform(0.05, 0.3); };
    switch (type) {
      case ShapeType::kBox:
        return Shape::Box({length(), length(), length()});
      case ShapeType::kSphere:
        return Shape::Sphere(length() / 2);
      case ShapeType::kCylinder:
        return Shape::Cylinder(length() / 2, length());
      case ShapeType::kCapsule:
        return Shape::Capsule(length() / 2, length());
      case ShapeType::kConvexMesh:
        break;
    }
    std::vector<Eigen::Vector3d> vertices(4 + Index(20));
    const Eigen::Vector3d offset = scale * Eigen::Vector3d(0.1, -0.2, 0.3);
    for (Eigen::Vector3d& v : vertices) v = offset + length() * Direction();
    return Shape::ConvexMesh(vertices);
  }

  Shape AnyShape(double scale = 1) { return AnyShape(static_cast<ShapeType>(Index(5)), scale); }

 private:
  std::mt19937 generator_;
  std::normal_distribution<> normal_;
};

}  // namespace possibility::models::testing
