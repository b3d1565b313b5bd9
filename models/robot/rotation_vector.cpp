#include "models/robot/rotation_vector.h"

#include <cmath>

#include "models/robot/cross_matrix.h"

namespace possibility::models {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// The scalars of the left Jacobian I + a [phi] + b [phi]^2 and of its derivative, as functions of
/// the angle: a = (1 - cos) / angle^2, b = (angle - sin) / angle^3, and a' / angle, b' / angle.
struct JacobianScalars {
  double a = 0;
  double b = 0;
  double da = 0;
  double db = 0;
};

/// Power series in angle^2: exact to rounding below one radian, where the closed forms cancel.
JacobianScalars SeriesScalars(double angle_squared) {
  JacobianScalars s;
  double factorial = 2;  // (2k + 2)!
  double power = 1;      // (-1)^k angle^(2k)
  double previous = 0;   // (-1)^k angle^(2k - 2)
  for (int k = 0; k < 10; ++k) {
    s.a += power / factorial;
    s.b += power / (factorial * (2 * k + 3));
    s.da += 2 * k * previous / factorial;
    s.db += 2 * k * previous / (factorial * (2 * k + 3));
    previous = -power;
    power *= -angle_squared;
    factorial *= (2 * k + 3) * (2 * k + 4);
  }
  return s;
}

JacobianScalars ScalarsOf(double angle_squared) {
  if (angle_squared < 1) return SeriesScalars(angle_squared);
  const double angle = std::sqrt(angle_squared);
  JacobianScalars s;
  s.a = (1 - std::cos(angle)) / angle_squared;
  s.b = (angle - std::sin(angle)) / (angle_squared * angle);
  s.da = (std::sin(angle) / angle - 2 * s.a) / angle_squared;
  s.db = (s.a - 3 * s.b) / angle_squared;
  return s;
}

}  // namespace

Vector3d RotationVector(const Eigen::Quaterniond& rotation) {
  const Eigen::AngleAxisd turn(rotation);
  return turn.angle() * turn.axis();
}

Vector3d RotationVector(const Matrix3d& rotation) {
  return RotationVector(Eigen::Quaterniond(rotation));
}

Eigen::AngleAxisd Exponential(const Vector3d& phi) {
  const double angle = phi.norm();
  if (angle == 0) return Eigen::AngleAxisd::Identity();
  return {angle, phi / angle};
}

Eigen::Quaterniond SmallestRotation(const Vector3d& from, const Vector3d& to) {
  constexpr double kOpposite = 1e-12;
  const Vector3d a = from.normalized();
  const Vector3d b = to.normalized();
  const double twice_cosine_of_half = (a + b).norm();
  Eigen::Quaterniond rotation;
  if (twice_cosine_of_half < kOpposite) {
    rotation.w() = 0;
    rotation.vec() = a.unitOrthogonal();
    return rotation;
  }
  rotation.w() = twice_cosine_of_half / 2;
  rotation.vec() = a.cross(b) / twice_cosine_of_half;
  return rotation.normalized();
}

Matrix3d LeftJacobian(const Vector3d& phi) {
  const JacobianScalars s = ScalarsOf(phi.squaredNorm());
  const Matrix3d X = CrossMatrix(phi);
  return Matrix3d::Identity() + s.a * X + s.b * X * X;
}

Matrix3d LeftJacobianRate(const Vector3d& phi, const Vector3d& phi_rate) {
  const JacobianScalars s = ScalarsOf(phi.squaredNorm());
  const Matrix3d X = CrossMatrix(phi);
  const Matrix3d dX = CrossMatrix(phi_rate);
  const double angle_times_rate = phi.dot(phi_rate);
  return angle_times_rate * (s.da * X + s.db * X * X) + s.a * dX + s.b * (dX * X + X * dX);
}

}  // namespace possibility::models
