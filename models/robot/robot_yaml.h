#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "models/robot/lumping.h"
#include "models/robot/robot_model.h"

namespace possibility::models {

/// Reads a robot YAML and the URDF it names. Links attached by fixed joints or by joints of the
/// YAML's `lump` list are lumped into their parents (mass properties and shapes).
/// @throws InputError for anything malformed, unknown, missing, NaN or physically impossible.
RobotModel LoadRobotModel(const std::filesystem::path& yaml_file);

/// What a robot's links look like: the `<visual>` elements of its URDF.
struct RobotVisuals {
  std::vector<Link> links;  ///< as the robot's, but `shapes` are those that are seen
  PendingMeshes meshes;     ///< none of which is read
  std::filesystem::path urdf_file;
  std::vector<std::filesystem::path> packages;  ///< as ResolveMeshPath takes them
};

/// Without links if the URDF has no `<visual>`.
/// @throws InputError if the robot's files are missing or malformed.
RobotVisuals LoadRobotVisuals(const std::filesystem::path& yaml_file);

/// RobotModel::content_hash of what LoadRobotModel would read, without understanding it.
/// @throws InputError if a file cannot be read, or the YAML names no URDF.
std::string RobotContentHash(const std::filesystem::path& yaml_file);

}  // namespace possibility::models
