#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "models/shapes/shape.h"

namespace possibility::models {

/// One rigid obstacle. If `is_ground`, its top face (a box standing upright, any yaw) is ground
/// that the robot may bear on.
struct Obstacle {
  std::string name;
  Shape shape;
  Eigen::Isometry3d X_WO = Eigen::Isometry3d::Identity();
  bool is_ground = false;
};

/// A static world. Immutable once loaded.
struct Environment {
  std::vector<Obstacle> obstacles;
  /// Allowed pelvis positions at a stance: x and y, m.
  Eigen::AlignedBox2d bounds;
};

}  // namespace possibility::models
