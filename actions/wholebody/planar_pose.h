#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace possibility::actions {

/// Angle wrapped to (-pi, pi].
inline double WrapAngle(double angle) {
  if (angle > -std::numbers::pi && angle <= std::numbers::pi) return angle;
  const double wrapped = std::remainder(angle, 2 * std::numbers::pi);
  return wrapped <= -std::numbers::pi ? wrapped + 2 * std::numbers::pi : wrapped;
}

/// A pose in SE(2), m and rad: a stance, seen from above.
struct PlanarPose {
  double x = 0;
  double y = 0;
  double yaw = 0;

  Eigen::Vector2d position() const { return {x, y}; }
  Eigen::Rotation2Dd rotation() const { return Eigen::Rotation2Dd(yaw); }

  /// For many points: one sine and cosine for all of them.
  Eigen::Isometry2d Transform() const {
    Eigen::Isometry2d X = Eigen::Isometry2d::Identity();
    X.linear() = rotation().toRotationMatrix();
    X.translation() = position();
    return X;
  }

  Eigen::Vector2d operator*(const Eigen::Vector2d& p) const { return position() + rotation() * p; }

  PlanarPose operator*(const PlanarPose& other) const {
    const Eigen::Vector2d p = *this * other.position();
    return {p.x(), p.y(), yaw + other.yaw};
  }

  PlanarPose Inverse() const {
    const Eigen::Vector2d p = -(Eigen::Rotation2Dd(-yaw) * position());
    return {p.x(), p.y(), -yaw};
  }

  /// The same pose in space, on a plane at height z.
  Eigen::Isometry3d At(double z) const {
    Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
    X.linear() = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    X.translation() << x, y, z;
    return X;
  }
};

/// Straight line in position and the shorter way in yaw; s in [0, 1].
inline PlanarPose Interpolate(const PlanarPose& a, const PlanarPose& b, double s) {
  return {a.x + s * (b.x - a.x), a.y + s * (b.y - a.y), a.yaw + s * WrapAngle(b.yaw - a.yaw)};
}

}  // namespace possibility::actions
