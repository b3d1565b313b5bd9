#pragma once

#include <vector>

#include "models/input/yaml_reader.h"
#include "models/robot/robot_model.h"

namespace possibility::models {

/// Reads the `gaits` list of a robot YAML (docs/file_formats.md). Links, joints and contacts of
/// `robot` must be complete. Checks nominal postures: joints within limits, contacts on z = 0.
/// @throws InputError for anything malformed or inconsistent.
std::vector<Gait> ReadGaits(const YamlNode& list, const RobotModel& robot);

/// Reads the `transitions` list. The gaits of `robot` must be complete.
std::vector<Transition> ReadTransitions(const YamlNode& list, const RobotModel& robot);

/// Reads the `jumps` list. The gaits of `robot` must be complete.
std::vector<Jump> ReadJumps(const YamlNode& list, const RobotModel& robot);

}  // namespace possibility::models
