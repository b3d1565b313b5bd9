#pragma once

#include "models/input/yaml_reader.h"
#include "models/world/environment.h"

namespace possibility::models {

/// Reads the `environment` map of a scenario YAML: bounds, ground boxes and obstacles
/// (docs/file_formats.md, "Scenario YAML").
/// @throws InputError for anything malformed, or if two bodies share a name.
Environment ReadEnvironment(const YamlNode& node);

}  // namespace possibility::models
