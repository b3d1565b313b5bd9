#pragma once

#include <filesystem>
#include <string>

#include "experiments/imports/imported_trajectory.h"
#include "models/robot/robot_model.h"

namespace possibility::experiments {

/// The arrays of docs/exports.md. Components are found by their names, or, without names, taken in
/// the order of the robot. Other arrays are ignored.
/// @throws InputError naming the file and the array.
ImportedTrajectory ParseTrajectoryNpz(const std::string& bytes, const std::filesystem::path& file,
                                      const models::RobotModel& robot);

}  // namespace possibility::experiments
