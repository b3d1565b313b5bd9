#pragma once

#include "experiments/command/command.h"

namespace possibility::experiments {

Command AddBenchCommand(CLI::App& program);

}  // namespace possibility::experiments
