#pragma once

#include "experiments/command/command.h"

namespace possibility::experiments {

/// `robot init`, `robot check`: from a URDF to a verified walk; what a robot can do and what
/// forbids the rest.
Command AddRobotCommand(CLI::App& program);

}  // namespace possibility::experiments
