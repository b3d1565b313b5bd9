#pragma once

#include <functional>

#include "experiments/support/command_options.h"

namespace possibility::experiments {

/// Exit codes of the program (docs/command_line.md). Any other code is a bug.
enum ExitCode : int {
  kDone = 0,
  kBadInput = 1,
  kNoPlan = 2,
  kVerificationFailed = 3,
  kInternalError = 4,
};

/// A command of the program: its part of the command line, and its execution after parsing.
struct Command {
  CommandOptions options;
  /// @throws InputError for bad input.
  std::function<ExitCode()> run;
};

}  // namespace possibility::experiments
