#pragma once

#include <filesystem>

#include "models/robot/robot_model.h"

namespace possibility::models {

/// Collision shapes end at most this far from the origin of their link, m. Lengths in millimetres
/// are an error that way, and checks between two instants stay quick: their number grows with the
/// speed of the farthest point.
inline constexpr double kFarthestOfShapes = 100;

/// @throws InputError naming `file` and the first link with a shape that reaches farther than
/// kFarthestOfShapes.
void RequireShapesInReach(const std::filesystem::path& file, const RobotModel& robot);

}  // namespace possibility::models
