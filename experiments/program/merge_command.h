#pragma once

#include "experiments/program/command.h"

namespace possibility::experiments {

Command AddMergeCommand(CLI::App& program);

}  // namespace possibility::experiments
