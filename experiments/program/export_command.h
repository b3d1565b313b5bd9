#pragma once

#include "experiments/command/command.h"

namespace possibility::experiments {

Command AddExportCommand(CLI::App& program);

}  // namespace possibility::experiments
