#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "actions/planner/planner_switches.h"
#include "experiments/support/command_options.h"
#include "experiments/trials/shard.h"
#include "experiments/trials/trial_record.h"
#include "models/robot/robot_model.h"
#include "models/world/scenario.h"

namespace possibility::experiments {

/// Options common to all experiments, as text.
struct ExperimentOptions {
  std::string trials = "50";
  std::string out;
  std::string preset = "default";
  std::string threads;
  std::string seed = "1";
  std::string shard;
  std::string time_limit;
  bool json = false;
};
void AddExperimentOptions(ExperimentOptions* options, CommandOptions* command);

struct ExperimentSettings {
  int trials = 50;  ///< per row and preset
  std::filesystem::path out;
  std::vector<actions::PlannerPreset> presets;
  int threads = 1;               ///< trials at a time
  std::uint64_t first_seed = 1;  ///< first of consecutive seeds
  Shard shard;
  std::optional<double> time_limit;  ///< s; none: the scenario's

  /// Hash of everything besides scenario and robot that comparable results must share.
  std::string Hash(const std::filesystem::path& library) const;
};

/// Without --shard: the shard of a Slurm job array, if this is one of its tasks. Without --out:
/// `default_out`.
/// @throws InputError for anything invalid.
ExperimentSettings ParseExperimentOptions(const ExperimentOptions& options,
                                          const std::filesystem::path& default_out);

/// Trials that differ only in preset and seed.
struct ExperimentRow {
  std::string name;  ///< letters, digits, '_', '-', '.', '=' only: used in file names
  TrialIdentity identity;
  std::shared_ptr<const models::RobotModel> robot;
  std::function<std::shared_ptr<const models::Scenario>(std::uint64_t seed)> scenario;
  std::vector<std::string> actions;  ///< empty: the scenario's
  std::string parameter;             ///< of a sweep; empty: none
  double value = 0;
};

/// The folder `jumps` beside the robot.
std::filesystem::path LibraryOf(const models::RobotModel& robot);

/// Path of the picture of a row's first trial within an experiment's folder.
std::filesystem::path PictureFile(const std::filesystem::path& folder, const std::string& row,
                                  const std::string& preset);

/// Runs the trials of the settings' shard that `file` lacks, and sorts the file, with rows in the
/// order of `row_order` (names, possibly of more rows).
/// @throws InputError as ResultsFile and RunTrial.
std::vector<TrialRecord> RunExperiment(const std::vector<ExperimentRow>& rows,
                                       const ExperimentSettings& settings,
                                       const std::filesystem::path& file,
                                       const std::vector<std::string>& row_order);

}  // namespace possibility::experiments
