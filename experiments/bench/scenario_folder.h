#pragma once

#include <filesystem>
#include <vector>

#include "models/robot/robot_model.h"
#include "models/world/scenario.h"

namespace possibility::experiments {

/// The scenarios of a folder (`.yaml`) that name this robot, by name of the file.
/// @throws InputError if there is none, or one cannot be read.
std::vector<models::Scenario> ScenariosOf(const models::RobotModel& robot,
                                          const std::filesystem::path& folder);

}  // namespace possibility::experiments
