#pragma once

#include <string>
#include <vector>

#include "models/input/yaml_reader.h"
#include "models/shapes/shape.h"

namespace possibility::models {

/// Keys that describe a posed shape in any YAML map (docs/file_formats.md, "Shapes").
extern const std::vector<std::string> kShapeKeys;

/// Reads `shape`, its dimensions, `position` and `rpy_deg` of a map. The caller checks the map's
/// keys against kShapeKeys and its own keys. Dimensions of another kind of shape are rejected here.
/// @throws InputError for anything missing or malformed.
PosedShape ReadPosedShape(const YamlNode& node);

/// Fixed-axis rotations about x, y, z in this order, rad.
Eigen::Quaterniond FromRollPitchYaw(const Eigen::Vector3d& rpy);

}  // namespace possibility::models
