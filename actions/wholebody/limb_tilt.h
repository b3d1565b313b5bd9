#pragma once

#include <Eigen/Geometry>

namespace possibility::actions {

/// The rotation Rz(yaw) Ry(pitch) Rx(roll), rad.
struct TurnAngles {
  double yaw = 0;
  double pitch = 0;
  double roll = 0;
};

/// `R`: must not pitch by 90 degrees.
TurnAngles AnglesOf(const Eigen::Matrix3d& R);
Eigen::Matrix3d RotationOf(const TurnAngles& angles);

/// Axes of what stands on ground of a normal (unit, upward): z along it, x above the heading, rad.
Eigen::Matrix3d StandingOn(const Eigen::Vector3d& normal, double heading);

bool IsLevel(const Eigen::Matrix3d& R);

/// Whether two patches, z out of the ground, bear on one plane that is not level.
bool BearOnOneSlope(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b);

}  // namespace possibility::actions
