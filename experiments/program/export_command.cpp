#include "experiments/program/export_command.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <memory>
#include <string>

#include "experiments/command/loaded_plan.h"
#include "experiments/exports/csv_export.h"
#include "experiments/exports/mcap_export.h"
#include "experiments/exports/mujoco_export.h"
#include "experiments/exports/npz_export.h"
#include "experiments/exports/plan_export.h"
#include "experiments/exports/sto_export.h"
#include "experiments/support/option_values.h"
#include "experiments/support/output_file.h"
#include "experiments/support/standard_streams.h"
#include "models/input/input_error.h"

namespace possibility::experiments {
namespace {

struct ExportOptions {
  std::string plan;
  std::string csv;
  std::string npz;
  std::string mujoco;
  std::string sto;
  std::string mcap;
  std::string plan_file;
  std::string period;
  std::string step;
  bool margins = false;
  bool torques = false;
};

/// A kind of export that is one file.
struct ExportFile {
  const char* option;
  std::string ExportOptions::*file;
  const char* help;
  void (*write)(const ExportSubject&, const ExportSampling&, const std::filesystem::path&);
};

constexpr ExportFile kFiles[] = {
    {"--npz", &ExportOptions::npz, "Arrays for NumPy", &WriteNpz},
    {"--mujoco", &ExportOptions::mujoco, "Model for MuJoCo with the motion as keyframes",
     &WriteMujoco},
    {"--sto", &ExportOptions::sto, "Storage for OpenSim", &WriteSto},
    {"--mcap", &ExportOptions::mcap, "Recording for Foxglove", &WriteMcap},
    {"--plan", &ExportOptions::plan_file, "The plan in format 1 (.json) or 2 (.zip)",
     &WritePlanFile}};

/// Writes every file that is asked for, and prints its name.
void WriteExports(const ExportOptions& options, const ExportSubject& subject,
                  const ExportSampling& sampling) {
  if (!options.csv.empty()) {
    PrepareOutputFolder("--csv", options.csv);
    for (const auto& file : WriteCsv(subject, sampling, options.csv)) {
      PrintOut("{}\n", file.string());
    }
  }
  for (const ExportFile& kind : kFiles) {
    const std::string& file = options.*kind.file;
    if (file.empty()) continue;
    kind.write(subject, sampling, file);
    PrintOut("{}\n", file);
  }
}

ExitCode RunExport(const ExportOptions& options) {
  const bool writes = !options.csv.empty() || std::any_of(std::begin(kFiles), std::end(kFiles),
                                                          [&](const ExportFile& kind) {
                                                            return !(options.*kind.file).empty();
                                                          });
  if (!writes) {
    throw InputError("usage: export: nothing to write, expected for instance --csv DIR");
  }
  ExportSampling sampling;
  sampling.margins = options.margins;
  sampling.torques = options.torques;
  if (!options.step.empty()) sampling.period = ParseSeconds("--step", options.step);
  if (!options.period.empty()) sampling.period = ParseSeconds("--period", options.period);
  const LoadedPlan loaded = LoadPlan(options.plan);
  RequireMotion(loaded);
  RequireFit(loaded);
  WriteExports(options, {loaded.plan, loaded.robot, loaded.scenario}, sampling);
  return kDone;
}

}  // namespace

Command AddExportCommand(CLI::App& program) {
  CommandOptions command(program, "export", "Writes a plan for other programs.");
  auto options = std::make_shared<ExportOptions>();
  command.AddRequired("PLAN", &options->plan, "plan.json, plan.zip or their folder");
  command.AddOptional("--csv", &options->csv, "Folder for tables");
  for (const ExportFile& kind : kFiles) {
    command.AddOptional(kind.option, &((*options).*kind.file), kind.help);
  }
  command.AddOptional("--period", &options->period,
                      "s between samples (default: the plan's knots)");
  command.AddOptional("--step", &options->step, "Older name of --period");
  command.AddFlag("--margins", &options->margins, "Also the margins at every sample");
  command.AddFlag("--torques", &options->torques,
                  "Torques in plan.zip even if they follow from the rest");
  return {command, [options] { return RunExport(*options); }};
}

}  // namespace possibility::experiments
