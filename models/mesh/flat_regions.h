#pragma once

#include <Eigen/Core>
#include <vector>

#include "models/mesh/triangle_mesh.h"

namespace possibility::models {

/// Connected triangles of a mesh that lie in one plane, near enough.
struct FlatRegion {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< unit, outwards
  double area = 0;                                    ///< m^2, of the triangles
  std::vector<int> triangles;                         ///< of the mesh
  /// Together the region: convex, exactly in one plane, counter-clockwise seen from outside.
  std::vector<std::vector<Eigen::Vector3d>> polygons;

  /// Whether its slope allows bearing: its normal points up and is at most kSteepestBearing from
  /// the vertical.
  bool IsLevelEnough() const;
};

/// Steepest slope that counts as ground, rad (45 degrees).
inline constexpr double kSteepestBearing = 0.78539816339744831;
/// m: no corner of a region's triangles lies farther from its plane.
inline constexpr double kFlatness = 1e-3;
/// rad (5 degrees): nor is any of its triangles turned farther from it, unless it is thinner than
/// kFlatness.
inline constexpr double kMostTurned = 0.0872664625997164788;
/// m^2: smaller regions are not worth standing on.
inline constexpr double kLeastGround = 1e-3;

/// All triangles of a mesh in regions, each triangle once. Regions grow across shared sides, from
/// the largest triangle that is left. The polygons of regions that are level enough cover what
/// their triangles cover, seen from above: corners move along z only, at most kFlatness across the
/// plane.
std::vector<FlatRegion> FlatRegions(const TriangleMesh& mesh);

}  // namespace possibility::models
