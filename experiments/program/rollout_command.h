#pragma once

#include "experiments/command/command.h"

namespace possibility::experiments {

Command AddRolloutCommand(CLI::App& program);

}  // namespace possibility::experiments
