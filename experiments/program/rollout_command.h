#pragma once

#include "experiments/program/command.h"

namespace possibility::experiments {

Command AddRolloutCommand(CLI::App& program);

}  // namespace possibility::experiments
