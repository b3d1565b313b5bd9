#pragma once

#include "experiments/program/command.h"

namespace possibility::experiments {

Command AddExportCommand(CLI::App& program);

}  // namespace possibility::experiments
