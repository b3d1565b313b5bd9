#pragma once

#include "experiments/command/command.h"

namespace possibility::experiments {

Command AddTableCommand(CLI::App& program);

}  // namespace possibility::experiments
