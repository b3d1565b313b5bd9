#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "models/mesh/triangle_mesh.h"
#include "models/shapes/shape.h"

namespace possibility::models {

/// One rigid obstacle. If `is_ground`, its top face (a box standing upright, any yaw) is ground
/// that the robot may bear on.
struct Obstacle {
  std::string name;
  Shape shape;
  Eigen::Isometry3d X_WO = Eigen::Isometry3d::Identity();
  bool is_ground = false;
  int surface = -1;  ///< of Environment::surfaces, which it is a piece of; -1: none
};

/// A flat piece of ground: a convex polygon, counter-clockwise as seen from above.
struct GroundFace {
  std::string name;
  std::vector<Eigen::Vector3d> corners;
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
  std::vector<GroundFace> faces;  ///< ground beside the tops of ground boxes
  std::vector<Surface> surfaces;
  /// Allowed pelvis positions at a stance: x and y, m.
  Eigen::AlignedBox2d bounds;
};

}  // namespace possibility::models
