#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "models/robot/robot_model.h"

namespace possibility::actions {

/// One thing that is known about a robot.
struct RobotFinding {
  std::string subject;  ///< "symmetry", "walk: torque", ...
  std::string text;
  bool is_fault = false;  ///< whether it keeps the robot from an action
};

/// Everything that can be said of a robot without a scene: its symmetry and, for each of its gaits,
/// balance, margins of joints and torques, links that are close, strides, speed and what forbids
/// more. All findings, not only the first fault. Paces are those of `library` (pace_library.h), which
/// may be empty; a gait without any there is fitted.
std::vector<RobotFinding> ReportOn(const models::RobotModel& robot,
                                   const std::filesystem::path& library);

}  // namespace possibility::actions
