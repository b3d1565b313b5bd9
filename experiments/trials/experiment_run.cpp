#include "experiments/trials/experiment_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <map>

#include "experiments/support/hardware_threads.h"
#include "experiments/support/option_values.h"
#include "experiments/support/output_file.h"
#include "experiments/support/preset_names.h"
#include "experiments/support/run_environment.h"
#include "experiments/trials/results_file.h"
#include "experiments/trials/trial_run.h"
#include "models/input/file_contents.h"

namespace possibility::experiments {
namespace {

namespace fs = std::filesystem;

constexpr int kMaxTrials = 1000000;

/// Hash of the names and contents of all files below a folder.
std::string FolderHash(const fs::path& folder) {
  if (!fs::is_directory(folder)) return "";
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  std::string hashes;
  for (const fs::path& file : files) {
    hashes += file.lexically_relative(folder).generic_string() + ' ' +
              models::ContentHash(models::ReadFileContents(file)) + '\n';
  }
  return models::ContentHash(hashes);
}

TrialTask TaskOf(const ExperimentRow& row, actions::PlannerPreset preset, std::uint64_t seed,
                 const ExperimentSettings& settings) {
  TrialTask task;
  task.key = {row.name, PresetName(preset), seed};
  task.identity = row.identity;
  task.parameter = row.parameter;
  task.value = row.value;
  task.robot = row.robot;
  task.scenario = [scenario = row.scenario, seed] { return scenario(seed); };
  task.request.threads = 1;  // one trial per core, and the same plan from the same seed
  task.request.actions = row.actions;
  task.request.library = LibraryOf(*row.robot);
  task.request.preset = preset;
  task.time_limit = settings.time_limit;
  if (seed == settings.first_seed) {
    task.picture = PictureFile(settings.out, row.name, task.key.preset);
  }
  return task;
}

/// Open trials of the shard, lowest seeds first, so that an interrupted run has results for all
/// rows.
std::vector<TrialTask> OpenTasks(const std::vector<ExperimentRow>& rows,
                                 const ExperimentSettings& settings, const ResultsFile& results) {
  std::vector<TrialTask> tasks;
  std::size_t index = 0;
  for (const ExperimentRow& row : rows) {
    for (const actions::PlannerPreset preset : settings.presets) {
      for (int i = 0; i < settings.trials; ++i) {
        const std::uint64_t seed = settings.first_seed + static_cast<std::uint64_t>(i);
        const TrialKey key{row.name, PresetName(preset), seed};
        if (!settings.shard.Has(index++) || results.Contains(key)) continue;
        tasks.push_back(TaskOf(row, preset, seed, settings));
      }
    }
  }
  std::stable_sort(tasks.begin(), tasks.end(),
                   [](const TrialTask& a, const TrialTask& b) { return a.key.seed < b.key.seed; });
  return tasks;
}

/// Removes leftovers of a run that was killed while writing a file.
void RemoveUnfinished(const fs::path& folder) {
  if (!fs::is_directory(folder)) return;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".unfinished") fs::remove(entry.path());
  }
}

}  // namespace

void AddExperimentOptions(ExperimentOptions* options, CommandOptions* command) {
  command->AddOptional("--trials", &options->trials, "Trials per row and preset");
  command->AddOptional("--out", &options->out, "Folder for results and reports");
  command->AddOptional("--preset", &options->preset, "Planner: default, paper or both");
  command->AddOptional("--threads", &options->threads,
                       "Trials at a time, 1 to 256 (default: all this machine has)");
  command->AddOptional("--seed", &options->seed, "Seed of the first trial; the others follow it");
  command->AddOptional("--shard", &options->shard,
                       "k/n: only part k of n, from 0 (default: the task of a Slurm job array)");
  command->AddOptional("--time-limit", &options->time_limit,
                       "s per trial (default: the scenario's)");
  command->AddFlag("--json", &options->json, "Print one JSON object");
}

ExperimentSettings ParseExperimentOptions(const ExperimentOptions& options,
                                          const fs::path& default_out) {
  ExperimentSettings settings;
  settings.trials = static_cast<int>(ParseInteger("--trials", options.trials, 1, kMaxTrials));
  settings.out = options.out.empty() ? default_out : fs::path(options.out);
  settings.presets = ParsePresets("--preset", options.preset);
  settings.threads =
      options.threads.empty()
          ? HardwareThreads()
          : static_cast<int>(ParseInteger("--threads", options.threads, 1, kMaxThreads));
  settings.first_seed = ParseInteger("--seed", options.seed, 0,
                                     std::numeric_limits<std::int64_t>::max() - kMaxTrials);
  settings.shard = options.shard.empty()
                       ? ShardOfSlurmTask([](const char* name) { return std::getenv(name); })
                       : ParseShard("--shard", options.shard);
  if (!options.time_limit.empty()) {
    settings.time_limit = ParseSeconds("--time-limit", options.time_limit);
  }
  return settings;
}

std::string ExperimentSettings::Hash(const fs::path& library) const {
  return models::ContentHash(fmt::format(
      "possibility {}, time limit {}, library {}", ThisEnvironment().possibility,
      time_limit ? fmt::format("{}", *time_limit) : "of the scenario", FolderHash(library)));
}

fs::path LibraryOf(const models::RobotModel& robot) { return robot.file.parent_path() / "jumps"; }

fs::path PictureFile(const fs::path& folder, const std::string& row, const std::string& preset) {
  return folder / "plans" / fmt::format("{}_{}.svg", row, preset);
}

std::vector<TrialRecord> RunExperiment(const std::vector<ExperimentRow>& rows,
                                       const ExperimentSettings& settings, const fs::path& file,
                                       const std::vector<std::string>& row_order) {
  PrepareOutputFolder("--out", settings.out / "plans");
  ResultsFile results(file);
  std::map<std::string, TrialIdentity> identities;
  for (const ExperimentRow& row : rows) identities[row.name] = row.identity;
  results.RequireSame(identities);
  for (const char* part : {".", "plans", "scenarios"}) RemoveUnfinished(settings.out / part);

  const std::vector<TrialTask> tasks = OpenTasks(rows, settings, results);
  const TrialProgressLine line;
  line.Show(0, tasks.size());
  RunTrials(tasks, settings.threads, &results,
            [&line](std::size_t done, std::size_t all) { line.Show(done, all); });
  results.Sort(row_order);
  return results.records();
}

}  // namespace possibility::experiments
