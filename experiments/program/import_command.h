#pragma once

#include "experiments/program/command.h"

namespace possibility::experiments {

Command AddImportCommand(CLI::App& program);

}  // namespace possibility::experiments
