#include "experiments/program/export_command.h"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "experiments/program/loaded_plan.h"
#include "experiments/report/csv_tables.h"
#include "experiments/support/option_values.h"
#include "experiments/support/output_file.h"
#include "experiments/support/standard_streams.h"
#include "models/input/atomic_file.h"

namespace possibility::experiments {
namespace {

struct ExportOptions {
  std::string plan;
  std::string csv;
  std::string step;
};

/// Row by row: a table may be larger than memory.
void WriteTables(const LoadedPlan& loaded, std::optional<double> step,
                 const std::filesystem::path& folder) {
  const TrajectoryTable trajectory(loaded.plan, loaded.robot);
  ContactForceTable forces(loaded.plan, loaded.robot);
  models::AtomicFile trajectory_file(folder / "trajectory.csv");
  models::AtomicFile forces_file(folder / "contact_forces.csv");
  trajectory_file.Write(trajectory.Header());
  forces_file.Write(forces.Header());
  const auto write = [&](const PlanSample& sample) {
    trajectory_file.Write(trajectory.Rows(sample));
    forces_file.Write(forces.Rows(sample));
  };
  if (step) {
    VisitEvery(loaded.plan, *step, write);
  } else {
    VisitKnots(loaded.plan, write);
  }
  trajectory_file.Commit();
  forces_file.Commit();
}

ExitCode RunExport(const ExportOptions& options) {
  std::optional<double> step;
  if (!options.step.empty()) step = ParseSeconds("--step", options.step);
  const LoadedPlan loaded = LoadPlan(options.plan);
  RequireMotion(loaded);
  RequireFit(loaded);
  const std::filesystem::path folder = options.csv;
  PrepareOutputFolder("--csv", folder);
  WriteTables(loaded, step, folder);
  PrintOut("{}\n{}\n", (folder / "trajectory.csv").string(),
           (folder / "contact_forces.csv").string());
  return kDone;
}

}  // namespace

Command AddExportCommand(CLI::App& program) {
  CommandOptions command(program, "export", "Writes a plan's numbers as CSV tables.");
  auto options = std::make_shared<ExportOptions>();
  command.AddRequired("PLAN", &options->plan, "plan.json or its folder");
  command.AddRequired("--csv", &options->csv, "Folder for the tables");
  command.AddOptional("--step", &options->step, "s between rows (default: the plan's knots)");
  return {command, [options] { return RunExport(*options); }};
}

}  // namespace possibility::experiments
