#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace possibility::experiments {

/// What the program ends with (docs/command_line.md). Anything else is a bug.
enum ExitCode : int {
  kDone = 0,
  kBadInput = 1,
  kNoPlan = 2,
  kVerificationFailed = 3,
  kInternalError = 4,
};

/// A command of the program: its part of the command line, and what it does once that is parsed.
struct Command {
  CLI::App* options = nullptr;
  /// @throws InputError for bad input.
  std::function<ExitCode()> run;
};

}  // namespace possibility::experiments
