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

Command AddPlanCommand(CLI::App& program);
Command AddVerifyCommand(CLI::App& program);
Command AddViewCommand(CLI::App& program);
Command AddExportCommand(CLI::App& program);
Command AddBenchCommand(CLI::App& program);
Command AddRegressCommand(CLI::App& program);
Command AddLibraryCommand(CLI::App& program);
Command AddTableCommand(CLI::App& program);
Command AddSweepCommand(CLI::App& program);
Command AddMergeCommand(CLI::App& program);

}  // namespace possibility::experiments
