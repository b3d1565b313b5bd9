#pragma once

#include <string>

#include "actions/onboarding/robot_draft.h"
#include "models/robot/robot_model.h"

namespace possibility::actions {

/// The robot YAML (docs/file_formats.md) of a draft whose robot has gaits. `urdf`: the URDF's path
/// from the YAML. All shapes are written, so that no mesh is read again.
std::string RobotYaml(const RobotDraft& draft, const std::string& urdf);

/// A level floor, a start and a goal `distance` (m) ahead. `robot`: the robot YAML's path from the
/// scenario.
std::string FlatScenarioYaml(const std::string& name, const std::string& robot, double distance,
                             double height);

}  // namespace possibility::actions
