#pragma once

#include "experiments/program/command.h"

namespace possibility::experiments {

Command AddVerifyCommand(CLI::App& program);

}  // namespace possibility::experiments
