#pragma once

#include "experiments/command/command.h"

namespace possibility::experiments {

Command AddVerifyCommand(CLI::App& program);

}  // namespace possibility::experiments
