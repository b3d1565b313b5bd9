#pragma once

#include "models/input/yaml_reader.h"
#include "models/robot/urdf_reader.h"

namespace possibility::models {

/// Reads the `inertials` list of a robot YAML (docs/file_formats.md) and replaces those of the
/// tree's links.
/// @throws InputError for anything malformed, an unknown link or one that is listed twice.
void ReadInertials(const YamlNode& list, UrdfTree* tree);

}  // namespace possibility::models
