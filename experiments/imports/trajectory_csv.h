#pragma once

#include <filesystem>
#include <string>

#include "experiments/imports/imported_trajectory.h"
#include "models/robot/robot_model.h"

namespace possibility::experiments {

/// The table trajectory.csv of docs/exports.md. Columns may be in any order; others are ignored.
/// @throws InputError naming the file and the line or column.
ImportedTrajectory ParseTrajectoryCsv(const std::string& text, const std::filesystem::path& file,
                                      const models::RobotModel& robot);

}  // namespace possibility::experiments
