#pragma once

#include "experiments/program/command.h"

namespace possibility::experiments {

Command AddTableCommand(CLI::App& program);

}  // namespace possibility::experiments
