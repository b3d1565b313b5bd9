#pragma once

#include "experiments/command/command.h"

namespace possibility::experiments {

Command AddPlanCommand(CLI::App& program);

}  // namespace possibility::experiments
