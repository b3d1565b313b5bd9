#pragma once

#include <filesystem>
#include <string>

#include "actions/jump_problem.h"
#include "actions/sit_down_problem.h"
#include "models/robot_model.h"

namespace possibility::actions {

/// Hash of whatever the solved motions of a robot depend on; solutions of another identity are
/// stale.
std::string MotionIdentity(const models::RobotModel& robot, const JumpSettings& jump,
                           const SitDownSettings& sit_down = {});

/// Where a library keeps the motions of one identity; empty if `library` is.
std::filesystem::path MotionFolder(const std::filesystem::path& library,
                                   const std::string& identity);

}  // namespace possibility::actions
