#include "experiments/program/plan_command.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "actions/planner/planner.h"
#include "actions/verify/verification_report.h"
#include "experiments/report/plan_summary.h"
#include "experiments/service/anytime.h"
#include "experiments/service/plan_output.h"
#include "experiments/service/plan_watch.h"
#include "experiments/support/file_name.h"
#include "experiments/support/hardware_threads.h"
#include "experiments/support/option_values.h"
#include "experiments/support/output_file.h"
#include "experiments/support/preset_names.h"
#include "experiments/support/progress_line.h"
#include "experiments/support/standard_streams.h"
#include "models/input/input_error.h"
#include "models/robot/robot_model.h"
#include "models/robot/robot_yaml.h"
#include "models/world/scenario.h"

namespace possibility::experiments {
namespace {

struct PlanOptions {
  std::string scenario;
  std::string out;
  std::string seed;
  std::string threads;
  std::string time_limit;
  std::string actions;
  std::string library;
  std::string preset;
  std::string explorers;
  std::string format;
  bool watch = false;
  bool anytime = false;
  bool json = false;
};

/// out/<name>, safe for any characters in the name.
std::filesystem::path DefaultFolder(const std::string& name) {
  return std::filesystem::path("out") / (name.empty() ? "plan" : SafeFileName(name));
}

/// Overlays the options on `request`, which holds the defaults.
void ApplyOptions(const PlanOptions& options, actions::PlanRequest* request) {
  if (!options.seed.empty()) {
    request->seed = ParseInteger("--seed", options.seed, 0, std::numeric_limits<int64_t>::max());
  }
  if (!options.threads.empty()) {
    request->threads = static_cast<int>(ParseInteger("--threads", options.threads, 1, kMaxThreads));
  }
  if (!options.time_limit.empty()) {
    request->time_limit = ParseSeconds("--time-limit", options.time_limit);
  }
  if (!options.actions.empty()) request->actions = ParseNames("--actions", options.actions);
  if (!options.format.empty()) {
    request->plan_version = static_cast<int>(ParseInteger("--format", options.format, 1, 2));
  }
  if (!options.preset.empty()) request->preset = ParsePreset("--preset", options.preset);
  if (!options.explorers.empty()) {
    request->explorers = ParseNames("--explorers", options.explorers);
    actions::WithExplorers({}, request->explorers, "--explorers");
  }
  if (!options.library.empty()) {
    if (!std::filesystem::is_directory(options.library)) {
      throw InputError(fmt::format("--library: '{}' is not a folder", options.library));
    }
    request->library = options.library;
  }
}

/// Requires actions that the scenario's file allows, because `verify` reads that file again.
void RequireAllowed(const std::vector<std::string>& actions, const models::Scenario& scenario) {
  const std::vector<std::string>& allowed = scenario.actions;
  for (const std::string& action : actions) {
    if (std::find(allowed.begin(), allowed.end(), action) != allowed.end()) continue;
    throw InputError(
        fmt::format("--actions: '{}' is not among the actions of {}, expected some of {}", action,
                    scenario.file.string(), fmt::join(allowed, ", ")));
  }
}

actions::PlanResult PlanWithProgress(const models::RobotModel& robot,
                                     const models::Scenario& scenario,
                                     actions::PlanRequest request) {
  ProgressLine line(request.time_limit);
  request.progress = [&line](const actions::PlanProgress& progress) { line.Show(progress); };
  return actions::PlanTraversal(robot, scenario, request);
}

ExitCode Report(const actions::PlanResult& result, const models::RobotModel& robot,
                const PlanFiles& files, bool json) {
  if (json) {
    PrintOut("{}\n", SummaryJson(result, robot, files));
  } else {
    PrintOut("{}", SummaryText(result, robot, files));
  }
  if (result.status == actions::PlanStatus::kFound) return kDone;
  PrintError("no plan: {}{}{}\n", actions::ToString(result.status),
             result.explanation.empty() ? "" : ": ", result.explanation);
  return kNoPlan;
}

/// The request for a scenario: its own settings, overlaid with the options.
/// @throws InputError if it does not allow the options' actions.
actions::PlanRequest RequestFor(const PlanOptions& options, const models::Scenario& scenario) {
  actions::PlanRequest request;
  request.seed = scenario.seed;
  request.threads = HardwareThreads();
  request.time_limit = scenario.time_limit;
  request.library = scenario.robot_file.parent_path() / "jumps";
  ApplyOptions(options, &request);
  RequireAllowed(request.actions, scenario);
  return request;
}

std::filesystem::path FolderFor(const PlanOptions& options, const models::Scenario& scenario) {
  return options.out.empty() ? DefaultFolder(scenario.name) : std::filesystem::path(options.out);
}

ExitCode RunWatch(const PlanOptions& options) {
  const models::Scenario first = models::LoadScenario(options.scenario);
  RequestFor(options, first);
  const std::filesystem::path folder = FolderFor(options, first);
  PrepareOutputFolder("--out", folder);
  WatchAndPlan({options.scenario, folder, options.json,
                [&options](const models::Scenario& now) { return RequestFor(options, now); }});
  return kDone;
}

ExitCode RunPlan(const PlanOptions& options) {
  actions::PlanRequest unused;
  ApplyOptions(options, &unused);  // finds their errors before any file is read
  if (options.watch && options.anytime) {
    throw InputError("--anytime: cannot be combined with --watch, expected one of them");
  }
  if (options.watch) return RunWatch(options);
  const models::Scenario scenario = models::LoadScenario(options.scenario);
  const actions::PlanRequest request = RequestFor(options, scenario);
  const models::RobotModel robot = models::LoadRobotModel(scenario.robot_file);
  const std::filesystem::path folder = FolderFor(options, scenario);
  PrepareOutputFolder("--out", folder);

  const PlanFiles files = PlanFilesIn(folder, request.plan_version);
  const actions::PlanResult result =
      options.anytime ? PlanAnytime(robot, scenario, request, files, options.json)
                      : PlanWithProgress(robot, scenario, request);
  if (result.status == actions::PlanStatus::kFound && !result.verification.accepted()) {
    PrintError("{}", actions::FormatText(result.verification));
    return kVerificationFailed;
  }
  WriteOnlyPlan(result.plan, robot, files);
  WritePage(result.plan, robot, scenario, files);
  // Its objects are printed.
  if (options.anytime && options.json && result.status == actions::PlanStatus::kFound) return kDone;
  return Report(result, robot, files, options.json);
}

}  // namespace

Command AddPlanCommand(CLI::App& program) {
  CommandOptions command(program, "plan", "Plans, verifies and writes a plan and a page.");
  auto options = std::make_shared<PlanOptions>();
  command.AddRequired("SCENARIO", &options->scenario, "Scenario YAML");
  command.AddOptional("--out", &options->out, "Folder for the plan (default: out/<scenario name>)");
  command.AddOptional("--seed", &options->seed, "Random seed (default: the scenario's)");
  command.AddOptional("--threads", &options->threads, "1 to 256 (default: all this machine has)");
  command.AddOptional("--time-limit", &options->time_limit, "s (default: the scenario's)");
  command.AddOptional("--actions", &options->actions,
                      "Of the scenario's only these, e.g. walk,crawl");
  command.AddOptional("--library", &options->library,
                      "Folder of solved jumps (default: jumps, beside the robot)");
  command.AddOptional("--preset", &options->preset, "Planner: default, or paper (as it prints it)");
  command.AddOptional("--explorers", &options->explorers,
                      "Only these: straight, lattice, random, shortcuts (default: the preset's)");
  command.AddOptional(
      "--format", &options->format,
      "1: plan.json (default); 2: plan.zip, a tenth as large and exact between knots");
  command.AddFlag("--watch", &options->watch,
                  "Plan again whenever the scenario's file changes, until interrupted");
  command.AddFlag("--anytime", &options->anytime,
                  "After the first plan look for quicker ones until the time limit");
  command.AddFlag("--json", &options->json,
                  "Print one JSON object; with --watch or --anytime one a line for each plan");
  return {command, [options] { return RunPlan(*options); }};
}

}  // namespace possibility::experiments
