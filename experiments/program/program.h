#pragma once

#include "experiments/command/command.h"

namespace possibility::experiments {

/// Runs the command that the arguments name. Reports every exception in one line; with --json also
/// as an object.
ExitCode RunProgram(int argc, char** argv);

}  // namespace possibility::experiments
