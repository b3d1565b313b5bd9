#pragma once

#include <optional>
#include <string>

#include "models/mesh/triangle_mesh.h"
#include "models/world/environment.h"

namespace possibility::models {

/// A surface in the world that may be obstacle and ground at once.
struct Terrain {
  std::string name;
  TriangleMesh mesh;  ///< in the world
  bool is_ground = true;
  /// The ground below a height map is solid down to this height, m. Without it, the surface is a
  /// sheet kSheet thick, below its outside.
  std::optional<double> base;
  double friction = kRobotsFriction;  ///< as of Obstacle
};

/// m.
inline constexpr double kSheet = 1e-3;

/// Adds the surface for drawing, its flat regions as convex obstacles, and, if it is ground, those
/// that can bear as ground faces. Obstacles and faces have the terrain's name.
///
/// Feet may touch what can bear, and what drops from its edge, such as the riser below a tread:
/// such obstacles are ground, all others are not.
void AddTerrain(const Terrain& terrain, Environment* environment);

}  // namespace possibility::models
