#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "actions/jump/jump_solver.h"
#include "models/robot/robot_model.h"

namespace possibility::experiments {

/// A solved jump from a library, as motion of the whole robot.
struct LoadedJump {
  std::filesystem::path file;
  models::RobotModel robot;
  models::Jump kind;  ///< from the robot's YAML
  std::shared_ptr<const actions::SolvedJump> jump;
  /// Whether the library matches this robot and the settings of this program; true for files
  /// outside a library.
  bool is_current = true;
};

/// Reads a jump from a library and realises it. `robot_file`: the robot YAML; if empty, the only
/// one beside the library's folder `jumps`.
/// @throws InputError if the robot cannot be determined or does not match the jump.
LoadedJump LoadJump(const std::filesystem::path& file, const std::filesystem::path& robot_file);

/// A page that plays the jump over two floors, with the widest gap it can cross between them, and
/// its plots beside it.
std::string JumpPage(const LoadedJump& loaded);

}  // namespace possibility::experiments
