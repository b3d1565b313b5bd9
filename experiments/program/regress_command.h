#pragma once

#include "experiments/command/command.h"

namespace possibility::experiments {

Command AddRegressCommand(CLI::App& program);

}  // namespace possibility::experiments
