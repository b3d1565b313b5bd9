#pragma once

#include "experiments/command/command.h"

namespace possibility::experiments {

Command AddMergeCommand(CLI::App& program);

}  // namespace possibility::experiments
