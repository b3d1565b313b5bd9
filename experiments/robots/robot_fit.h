#pragma once

#include <filesystem>
#include <string>

#include "experiments/command/command.h"

namespace possibility::experiments {

struct RobotFitOptions {
  std::filesystem::path robot;  ///< YAML
  std::string gait = "walk";
  double fit_seconds = 90;
  bool json = false;
};

/// Fits the posture and the numbers of a gait on two feet again, walks on a level floor with them,
/// and writes them into the YAML, which otherwise stays as it is, if the walk is verified and
/// quicker than before. The folder `jumps` beside it gets the paces.
/// kDone; kNoPlan if no walk is found, neither before nor after. @throws InputError.
ExitCode FitRobot(const RobotFitOptions& options);

}  // namespace possibility::experiments
