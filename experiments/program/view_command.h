#pragma once

#include "experiments/program/command.h"

namespace possibility::experiments {

Command AddViewCommand(CLI::App& program);

}  // namespace possibility::experiments
