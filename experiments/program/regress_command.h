#pragma once

#include "experiments/program/command.h"

namespace possibility::experiments {

Command AddRegressCommand(CLI::App& program);

}  // namespace possibility::experiments
