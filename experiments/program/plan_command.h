#pragma once

#include "experiments/program/command.h"

namespace possibility::experiments {

Command AddPlanCommand(CLI::App& program);

}  // namespace possibility::experiments
