#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "actions/jump/jump_solver.h"
#include "models/robot/robot_model.h"

namespace possibility::experiments {

/// A solved jump of a library, as motion of the whole robot.
struct LoadedJump {
  std::filesystem::path file;
  models::RobotModel robot;
  models::Jump kind;  ///< what the robot's YAML says of it
  std::shared_ptr<const actions::SolvedJump> jump;
  /// Whether the library is of this very robot and of the settings of this program; true for
  /// files that are in none.
  bool is_current = true;
};

/// Reads a jump of a library and realises it. `robot_file`: the robot YAML; if empty, the only one
/// beside the library's folder `jumps`.
/// @throws InputError if the robot cannot be told, or is not one that the jump is of.
LoadedJump LoadJump(const std::filesystem::path& file, const std::filesystem::path& robot_file);

/// A page that plays the jump over two floors with as wide a gap between them as it leads over, its
/// plots beside it.
std::string JumpPage(const LoadedJump& loaded);

}  // namespace possibility::experiments
