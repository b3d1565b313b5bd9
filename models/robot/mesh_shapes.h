#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "models/robot/lumping.h"
#include "models/robot/robot_model.h"

namespace possibility::models {

/// What the robot was made of, besides its YAML and URDF.
struct MeshFiles {
  std::vector<std::filesystem::path> files;  ///< each once, in the order of first use
  std::vector<std::string> contents;         ///< their bytes
};

/// A mesh's convex hull has at most this many corners: distances cost time with each.
inline constexpr int kMostHullCorners = 64;

/// Adds the convex hull of each mesh to its link's shapes (SimpleHullOfPoints, so it contains the
/// mesh), and returns the files that were read. `packages`: see ResolveMeshPath.
/// @throws InputError naming the URDF, the link and the file if a mesh is missing, outside of the
/// folders named, malformed or flat.
MeshFiles AddMeshShapes(const PendingMeshes& meshes, const std::filesystem::path& urdf_file,
                        const std::vector<std::filesystem::path>& packages, RobotModel* robot);

}  // namespace possibility::models
