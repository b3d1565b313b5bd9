#pragma once

#include <filesystem>
#include <string>

#include "models/input/yaml_reader.h"
#include "models/world/terrain.h"

namespace possibility::models {

/// A terrain and the ContentHash of the file that it came from.
struct TerrainFile {
  Terrain terrain;
  std::string content_hash;
};

/// The key `friction` of anything that may be ground (Obstacle::friction).
double ReadGroundFriction(const YamlNode& node);

/// Reads an element of `meshes` or of `height_maps` (docs/file_formats.md, "Scenario YAML") and the
/// file that it names, relative to `folder`.
/// @throws InputError for anything missing or malformed, or if the surface is longer than a
/// kilometre or shorter than a millimetre: then the unit is probably wrong.
TerrainFile ReadMeshTerrain(const YamlNode& node, const std::filesystem::path& folder);
TerrainFile ReadHeightMapTerrain(const YamlNode& node, const std::filesystem::path& folder);

}  // namespace possibility::models
