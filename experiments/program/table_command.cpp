#include "experiments/program/table_command.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "experiments/command/report_output.h"
#include "experiments/trials/experiment_run.h"
#include "experiments/trials/row_robots.h"
#include "experiments/trials/table_report.h"
#include "experiments/trials/table_rows.h"
#include "models/input/input_error.h"
#include "models/input/nearest_name.h"

namespace possibility::experiments {
namespace {

constexpr int kTwinTrials = 20;

struct TableOptions {
  ExperimentOptions experiment;
  std::string scenario;
  std::string scenarios = "experiments/scenarios";
  bool twins = false;
};

/// Rows, their scenarios and robots each loaded once.
class RowLoader {
 public:
  RowLoader(std::filesystem::path folder, const ExperimentSettings& settings)
      : folder_(std::move(folder)), robots_(settings) {}

  ExperimentRow Load(const std::string& experiment, const std::string& name,
                     const std::string& scenario_name, const std::vector<std::string>& actions) {
    const auto scenario = Scenario(scenario_name);
    ExperimentRow row = robots_.RowOf(experiment, name, *scenario, scenario->content_hash);
    row.scenario = [scenario](std::uint64_t) { return scenario; };
    row.actions = actions;
    return row;
  }

 private:
  std::shared_ptr<const models::Scenario> Scenario(const std::string& name) {
    auto& scenario = scenarios_[name];
    if (!scenario) {
      scenario = std::make_shared<const models::Scenario>(
          models::LoadScenario(folder_ / (name + ".yaml")));
    }
    return scenario;
  }

  std::filesystem::path folder_;
  RowRobots robots_;
  std::map<std::string, std::shared_ptr<const models::Scenario>> scenarios_;
};

/// Requested rows and twins.
struct Selection {
  std::vector<TableRow> rows;
  std::vector<std::string> twins;
};

/// `name`: of a scenario or of a row; empty: everything. A twin is selected if `name` names it.
Selection Select(const std::string& name, bool with_twins) {
  Selection selection;
  std::vector<std::string> known;
  for (const TableRow& row : TableRows()) {
    known.push_back(row.scenario);
    known.push_back(row.name);
    if (name.empty() || name == row.scenario || name == row.name) selection.rows.push_back(row);
  }
  for (const std::string& twin : InfeasibleTwins()) {
    known.push_back(twin);
    if (name == twin || (name.empty() && with_twins)) selection.twins.push_back(twin);
  }
  if (!selection.rows.empty() || !selection.twins.empty()) return selection;
  std::sort(known.begin(), known.end());
  known.erase(std::unique(known.begin(), known.end()), known.end());
  throw InputError(fmt::format("--scenario: there is no row or scenario '{}', expected one of {}{}",
                               name, fmt::join(known, ", "), models::DidYouMean(name, known)));
}

std::vector<TrialRecord> RunRows(const Selection& selection, const ExperimentSettings& settings,
                                 RowLoader* loader) {
  if (selection.rows.empty()) return {};
  std::vector<ExperimentRow> rows;
  for (const TableRow& row : selection.rows) {
    rows.push_back(loader->Load("table", row.name, row.scenario, row.actions));
  }
  return RunExperiment(rows, settings, settings.out / "results.jsonl", TableRowOrder());
}

/// Runs the twins with the default planner only: without floods every "no" is the time limit.
std::vector<TrialRecord> RunTwins(const Selection& selection, ExperimentSettings settings,
                                  RowLoader* loader) {
  if (selection.twins.empty()) return {};
  settings.presets = {actions::PlannerPreset::kDefault};
  settings.trials = std::min(settings.trials, kTwinTrials);
  std::vector<ExperimentRow> rows;
  for (const std::string& twin : selection.twins) {
    rows.push_back(loader->Load("twins", twin, twin, {}));
  }
  return RunExperiment(rows, settings, settings.out / "twins.jsonl", TableRowOrder());
}

ExitCode RunTable(const TableOptions& options) {
  const ExperimentSettings settings =
      ParseExperimentOptions(options.experiment, std::filesystem::path("out") / "table");
  const Selection selection = Select(options.scenario, options.twins);
  RowLoader loader(options.scenarios, settings);
  TableReport report;
  report.trials = RunRows(selection, settings, &loader);
  report.twins = RunTwins(selection, settings, &loader);
  PutOutReport(report, settings.out, options.experiment.json);
  return kDone;
}

}  // namespace

Command AddTableCommand(CLI::App& program) {
  CommandOptions command(program, "table", "The paper's Table 1, ours beside it.");
  auto options = std::make_shared<TableOptions>();
  AddExperimentOptions(&options->experiment, &command);
  command.AddOptional("--scenario", &options->scenario, "Only rows of this scenario, or one row");
  command.AddOptional("--scenarios", &options->scenarios, "Folder of the scenarios");
  command.AddFlag("--twins", &options->twins, "The scenarios without a way through as well");
  return {command, [options] { return RunTable(*options); }};
}

}  // namespace possibility::experiments
