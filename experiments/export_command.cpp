#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "experiments/commands.h"
#include "experiments/csv_tables.h"
#include "experiments/loaded_plan.h"
#include "experiments/option_values.h"
#include "experiments/output_file.h"

namespace possibility::experiments {
namespace {

struct ExportOptions {
  std::string plan;
  std::string csv;
  std::string step;
};

ExitCode RunExport(const ExportOptions& options) {
  std::optional<double> step;
  if (!options.step.empty()) step = ParseSeconds("--step", options.step);
  const LoadedPlan loaded = LoadPlan(options.plan);
  RequireMotion(loaded);
  RequireFit(loaded);
  const std::vector<PlanSample> samples =
      step ? SamplesEvery(loaded.plan, *step) : SamplesAtKnots(loaded.plan);
  const std::filesystem::path folder = options.csv;
  PrepareOutputFolder("--csv", folder);
  WriteOutput(folder / "trajectory.csv", TrajectoryCsv(samples, loaded.plan, loaded.robot));
  WriteOutput(folder / "contact_forces.csv", ContactForcesCsv(samples, loaded.plan, loaded.robot));
  fmt::print("{}\n{}\n", (folder / "trajectory.csv").string(),
             (folder / "contact_forces.csv").string());
  return kDone;
}

}  // namespace

Command AddExportCommand(CLI::App& program) {
  CLI::App* app = program.add_subcommand("export", "Writes a plan's numbers as CSV tables.");
  auto options = std::make_shared<ExportOptions>();
  app->add_option("PLAN", options->plan, "plan.json or its folder")->required();
  app->add_option("--csv", options->csv, "Folder for the tables")->required();
  app->add_option("--step", options->step, "s between rows (default: the plan's knots)");
  return {app, [options] { return RunExport(*options); }};
}

}  // namespace possibility::experiments
