#pragma once

#include "experiments/command/command.h"

namespace possibility::experiments {

Command AddImportCommand(CLI::App& program);

}  // namespace possibility::experiments
