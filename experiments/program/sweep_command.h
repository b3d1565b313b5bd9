#pragma once

#include "experiments/program/command.h"

namespace possibility::experiments {

Command AddSweepCommand(CLI::App& program);

}  // namespace possibility::experiments
