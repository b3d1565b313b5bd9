#pragma once

#include <Eigen/Geometry>
#include <limits>
#include <string>
#include <vector>

#include "models/mesh/triangle_mesh.h"
#include "models/shapes/shape.h"

namespace possibility::models {

/// Friction coefficient of ground that does not state one: the robot's own counts.
inline constexpr double kRobotsFriction = std::numeric_limits<double>::infinity();

/// One rigid obstacle. The robot may bear on it if `is_ground`: on the side of a box that faces up
/// most (GroundMap), or where Environment::faces says so.
struct Obstacle {
  std::string name;
  Shape shape;
  Eigen::Isometry3d X_WO = Eigen::Isometry3d::Identity();
  bool is_ground = false;
  int surface = -1;  ///< of Environment::surfaces, which it is a piece of; -1: none
  /// Of ground: the lesser of this and the robot's friction coefficient counts.
  double friction = kRobotsFriction;
  /// Of ground: an obstacle that single steps may bear on. No level (GroundMap::levels).
  bool is_for_steps = false;
};

/// A convex polygon of one plane that the robot may bear on, in the world.
struct GroundFace {
  std::string name;
  std::vector<Eigen::Vector3d> corners;  ///< m, counter-clockwise seen from above
  double friction = kRobotsFriction;     ///< as of Obstacle
};

/// A mesh or height map as its file has it, in the world. Its obstacles are pieces of it, and its
/// ground is among Environment::faces.
struct Surface {
  std::string name;
  TriangleMesh mesh;
  bool is_ground = false;
  std::vector<double> headings;  ///< rad, square to most sides of its ground
};

/// A static world. Immutable once loaded.
struct Environment {
  std::vector<Obstacle> obstacles;
  std::vector<GroundFace> faces;  ///< ground beside that of boxes
  std::vector<Surface> surfaces;
  /// Allowed pelvis positions at a stance: x and y, m.
  Eigen::AlignedBox2d bounds;
};

}  // namespace possibility::models
