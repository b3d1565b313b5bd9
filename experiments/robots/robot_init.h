#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "experiments/command/command.h"

namespace possibility::experiments {

struct RobotInitOptions {
  std::filesystem::path urdf;  ///< or an MJCF file
  bool is_mjcf = false;
  std::optional<std::filesystem::path> srdf;
  std::vector<std::filesystem::path> packages;
  std::filesystem::path out;
  double fit_seconds = 90;  ///< for the search of the gait's numbers
  bool json = false;
};

/// Derives a robot from a URDF, writes its folder (a copy of the URDF, robot.yaml, flat.yaml, the
/// paces in jumps/), plans and verifies a walk on a level floor and writes plan.json and its page.
/// Prints what was assumed and why. kNoPlan if no walk was found.
/// An MJCF file is restated as a URDF with its meshes in the robot's folder first (ReadMjcf).
/// @throws InputError for a URDF, MJCF, SRDF or mesh that cannot be used.
ExitCode InitRobot(const RobotInitOptions& options);

}  // namespace possibility::experiments
