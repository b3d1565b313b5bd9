#pragma once

#include "experiments/program/command.h"

namespace possibility::experiments {

Command AddLibraryCommand(CLI::App& program);

}  // namespace possibility::experiments
