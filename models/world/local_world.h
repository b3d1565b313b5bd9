#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "models/world/environment.h"
#include "models/world/ground_map.h"

namespace possibility::models {

/// The part of a world that a judgement may read: solids that meet one box, ground that meets
/// another (m, world). An empty box meets nothing.
struct WorldReach {
  Eigen::AlignedBox3d solids;
  Eigen::AlignedBox3d ground;
};

/// Tells whether two worlds are the same within a reach. A judgement that reads nothing beyond its
/// reach is the same in both if Within is.
class LocalWorld {
 public:
  /// Both must outlive it; `ground` is the environment's.
  LocalWorld(const Environment& environment, const GroundMap& ground);

  /// Every number of what is within reach, byte for byte, in the environment's order: shapes and
  /// places of solids and of ground, corners of faces, and the planes that the ground is merged
  /// into. Names do not count. Whatever is within 1e-4 m of a box meets it.
  std::string Within(const WorldReach& reach) const;

 private:
  const Environment* environment_;
  const GroundMap* ground_;
  std::vector<Eigen::AlignedBox3d> solid_bounds_;  ///< by obstacle
  std::vector<Eigen::AlignedBox3d> face_bounds_;
};

}  // namespace possibility::models
