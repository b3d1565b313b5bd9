#include "experiments/program/program.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <exception>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "actions/plan/plan.h"
#include "experiments/command/command.h"
#include "experiments/program/bench_command.h"
#include "experiments/program/export_command.h"
#include "experiments/program/import_command.h"
#include "experiments/program/library_command.h"
#include "experiments/program/merge_command.h"
#include "experiments/program/plan_command.h"
#include "experiments/program/regress_command.h"
#include "experiments/program/rollout_command.h"
#include "experiments/program/sweep_command.h"
#include "experiments/program/table_command.h"
#include "experiments/program/verify_command.h"
#include "experiments/program/view_command.h"
#include "experiments/robots/robot_command.h"
#include "experiments/support/run_environment.h"
#include "experiments/support/standard_streams.h"
#include "models/input/input_error.h"
#include "models/input/json_text.h"

namespace possibility::experiments {
namespace {

constexpr Command (*kCommands[])(CLI::App&) = {
    &AddPlanCommand,   &AddVerifyCommand, &AddRolloutCommand, &AddViewCommand,    &AddExportCommand,
    &AddImportCommand, &AddBenchCommand,  &AddRegressCommand, &AddLibraryCommand, &AddTableCommand,
    &AddSweepCommand,  &AddMergeCommand,  &AddRobotCommand};

std::string OneLine(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text.substr(0, text.find_last_not_of(' ') + 1);
}

std::string Version() {
  return fmt::format("possibility {}\nplan format {}, {}", ThisEnvironment().possibility,
                     actions::kPlanFormat, actions::kPackedPlanFormat);
}

/// Prints one line of text; with --json also an object, so that a caller always has one to parse.
ExitCode Fail(ExitCode code, const std::string& message, bool json) {
  const std::string line = OneLine(message);
  PrintError("{}\n", line);
  if (!json) return code;
  const nlohmann::ordered_json object = {{"status", "error"}, {"error", line}};
  try {
    PrintOut("{}\n", models::JsonText(object));
  } catch (const InputError&) {
    // Standard output may be what failed.
  }
  return code;
}

ExitCode RunCommand(int argc, char** argv) {
  CLI::App program("Plans how a humanoid robot gets through an environment.", "possibility");
  program.require_subcommand(1);
  program.set_version_flag("--version", &Version, "Print the versions of program and plan files");
  std::vector<Command> commands;
  for (const auto add : kCommands) commands.push_back(add(program));
  try {
    program.parse(argc, argv);
  } catch (const CLI::Success& help) {
    std::ostringstream text;
    program.exit(help, text, text);
    WriteStandardOutput(text.str());
    return kDone;
  }
  const auto chosen = std::find_if(commands.begin(), commands.end(), [](const Command& command) {
    return command.options.IsChosen();
  });
  return chosen->run();
}

}  // namespace

ExitCode RunProgram(int argc, char** argv) {
  const bool json = std::any_of(
      argv + 1, argv + argc, [](const char* word) { return std::string_view(word) == "--json"; });
  try {
    return RunCommand(argc, argv);
  } catch (const CLI::ParseError& error) {
    return Fail(kBadInput, fmt::format("usage: {} (see possibility --help)", error.what()), json);
  } catch (const InputError& error) {
    return Fail(kBadInput, error.what(), json);
  } catch (const std::exception& error) {
    return Fail(kInternalError, fmt::format("internal error: {}", error.what()), json);
  }
}

}  // namespace possibility::experiments
