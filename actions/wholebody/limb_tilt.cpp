#include "actions/wholebody/limb_tilt.h"

#include <algorithm>
#include <cmath>

namespace possibility::actions {
namespace {

using Eigen::AngleAxisd;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kSameDirection = 1e-9;
constexpr double kSamePlane = 1e-6;  // m

}  // namespace

TurnAngles AnglesOf(const Matrix3d& R) {
  return {std::atan2(R(1, 0), R(0, 0)), -std::asin(std::clamp(R(2, 0), -1.0, 1.0)),
          std::atan2(R(2, 1), R(2, 2))};
}

Matrix3d RotationOf(const TurnAngles& angles) {
  return (AngleAxisd(angles.yaw, Vector3d::UnitZ()) * AngleAxisd(angles.pitch, Vector3d::UnitY()) *
          AngleAxisd(angles.roll, Vector3d::UnitX()))
      .toRotationMatrix();
}

Matrix3d StandingOn(const Vector3d& normal, double heading) {
  const Vector3d above(std::cos(heading), std::sin(heading), 0);
  const Vector3d x = (above - above.dot(normal) / normal.z() * Vector3d::UnitZ()).normalized();
  Matrix3d R;
  R << x, normal.cross(x), normal;
  return R;
}

bool IsLevel(const Matrix3d& R) { return (R.col(2) - Vector3d::UnitZ()).norm() < kSameDirection; }

bool BearOnOneSlope(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  const Vector3d normal = a.linear().col(2);
  return !IsLevel(a.linear()) && (normal - b.linear().col(2)).norm() < kSameDirection &&
         std::abs(normal.dot(b.translation() - a.translation())) < kSamePlane;
}

}  // namespace possibility::actions
