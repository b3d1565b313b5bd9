#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/mjcf/mjcf_robot.h"

namespace possibility::experiments {

/// The meshes by which a robot is seen, as files of its own folder.
struct SeenMeshes {
  std::string urdf;                   ///< names them in its `<visual>` elements
  std::vector<NamedBytes> files;      ///< binary STL
  std::size_t triangles = 0;          ///< in all
  std::vector<std::string> warnings;  ///< meshes that cannot be read; they keep their names
};

/// Copies the meshes of a URDF's `<visual>` elements, with at most kMostSeenTriangles in all.
/// `urdf`: its text; `urdf_file`, `packages`: where its meshes are (ResolveMeshPath).
SeenMeshes CopySeenMeshes(const std::string& urdf, const std::filesystem::path& urdf_file,
                          const std::vector<std::filesystem::path>& packages);

}  // namespace possibility::experiments
