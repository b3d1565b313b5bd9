#pragma once

#include <filesystem>

#include "experiments/imports/imported_trajectory.h"
#include "models/robot/robot_model.h"

namespace possibility::experiments {

/// Reads a trajectory as `export` writes it (docs/exports.md): a CSV table or, if the file begins
/// like a ZIP archive, arrays of NumPy. t, q and contacts are required. `robot`: names of joints
/// and contact points.
/// @throws InputError naming the file and the row, column or array.
ImportedTrajectory ReadTrajectory(const std::filesystem::path& file,
                                  const models::RobotModel& robot);

}  // namespace possibility::experiments
