#pragma once

#include "models/input/yaml_reader.h"
#include "models/robot/robot_model.h"

namespace possibility::models {

/// Reads the list `actuators` of a robot YAML (docs/file_formats.md) into the robot's joints, whose
/// limits must have been read.
/// @throws InputError that names file, line and key: an unknown key or joint, a joint listed twice,
/// a mimic joint, a number out of range, half a torque-speed line, or one that begins below the
/// joint's torque limit or ends within its speed limit.
void ReadActuators(const YamlNode& list, RobotModel* robot);

}  // namespace possibility::models
