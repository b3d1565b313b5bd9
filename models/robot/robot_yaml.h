#pragma once

#include <filesystem>
#include <string>

#include "models/robot/robot_model.h"

namespace possibility::models {

/// Reads a robot YAML and the URDF it names. Links attached by fixed joints or by joints of the
/// YAML's `lump` list are lumped into their parents (mass properties and shapes).
/// @throws InputError for anything malformed, unknown, missing, NaN or physically impossible.
RobotModel LoadRobotModel(const std::filesystem::path& yaml_file);

/// RobotModel::content_hash of what LoadRobotModel would read, without understanding it.
/// @throws InputError if a file cannot be read, or the YAML names no URDF.
std::string RobotContentHash(const std::filesystem::path& yaml_file);

}  // namespace possibility::models
