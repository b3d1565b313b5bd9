#pragma once

#include "experiments/program/command.h"

namespace possibility::experiments {

Command AddBenchCommand(CLI::App& program);

}  // namespace possibility::experiments
