#pragma once

#include <filesystem>
#include <string>

namespace possibility::models {

/// RobotModel::content_hash of what LoadRobotModel would read, without understanding it.
/// @throws InputError if a file cannot be read, or the YAML names no URDF.
std::string RobotContentHash(const std::filesystem::path& yaml_file);

}  // namespace possibility::models
