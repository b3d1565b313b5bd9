#pragma once

#include "experiments/command/command.h"

namespace possibility::experiments {

Command AddViewCommand(CLI::App& program);

}  // namespace possibility::experiments
