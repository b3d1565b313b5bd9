#pragma once

#include <Eigen/Core>
#include <limits>
#include <vector>

namespace possibility::dynamics {

/// A point of the robot that bears on the ground.
struct ContactPoint {
  int link = 0;
  Eigen::Vector3d p_L = Eigen::Vector3d::Zero();
  /// Unit, out of the ground towards the robot; read only where friction cones matter.
  Eigen::Vector3d normal_W = Eigen::Vector3d::UnitZ();
  /// Friction coefficient of its ground, where friction cones matter; the robot's own counts if
  /// that is less.
  double friction = std::numeric_limits<double>::infinity();
};

/// @throws std::invalid_argument with a message that begins with `caller` if a point names no link
/// of `num_links` or is not finite, its normal is not a unit vector, or its
/// friction is not positive.
void CheckContactPoints(const char* caller, int num_links, const std::vector<ContactPoint>& points);

}  // namespace possibility::dynamics
