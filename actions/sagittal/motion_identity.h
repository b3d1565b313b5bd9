#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "actions/sagittal/sagittal_problem.h"
#include "models/robot/robot_model.h"

namespace possibility::actions {

/// Hash of what the solved motions of a robot depend on: the robot, the settings of their problem,
/// and `own`, the fields that a kind of motion adds to them. Solutions of another identity are
/// stale.
std::string MotionIdentity(const models::RobotModel& robot, const SagittalSettings& settings,
                           const std::vector<double>& own);

/// Where a library keeps the motions of one identity; empty if `library` is.
std::filesystem::path MotionFolder(const std::filesystem::path& library,
                                   const std::string& identity);

}  // namespace possibility::actions
