#pragma once

#include "experiments/command/command.h"

namespace possibility::experiments {

Command AddSweepCommand(CLI::App& program);

}  // namespace possibility::experiments
