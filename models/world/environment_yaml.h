#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "models/input/yaml_reader.h"
#include "models/world/environment.h"

namespace possibility::models {

/// Reads the `environment` map of a scenario YAML: bounds, ground boxes, obstacles, meshes and
/// height maps (docs/file_formats.md, "Scenario YAML"). Files are relative to `folder`; `hashes`
/// takes the ContentHash of each that was read, in order.
/// @throws InputError for anything malformed, or if two bodies share a name.
Environment ReadEnvironment(const YamlNode& node, const std::filesystem::path& folder,
                            std::vector<std::string>* hashes);

}  // namespace possibility::models
