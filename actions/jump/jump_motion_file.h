#pragma once

#include <filesystem>

#include "actions/jump/solved_jump.h"
#include "models/robot/robot_model.h"

namespace possibility::actions {

/// Writes the motion of a solved jump: a plan of version 2 (docs/file_formats.md) without robot and
/// scenario, with a segment "preparation", if there is one, and a segment "jump". Numbers are so
/// much finer than in a plan that the plan's own rounding decides. @throws InputError if that
/// fails.
void WriteJumpMotion(const SolvedJump& jump, const models::RobotModel& robot,
                     const std::filesystem::path& file);

/// Inverse of WriteJumpMotion; the jump is of `task`. @throws InputError if the file is not such a
/// plan or its motion is not the robot's.
SolvedJump ReadJumpMotion(const JumpTask& task, const models::RobotModel& robot,
                          const std::filesystem::path& file);

}  // namespace possibility::actions
