#pragma once

#include "experiments/command/command.h"

namespace possibility::experiments {

Command AddLibraryCommand(CLI::App& program);

}  // namespace possibility::experiments
