#include "experiments/program/sweep_command.h"

#include <fmt/format.h>

#include <cctype>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "actions/crossing/step_over.h"
#include "experiments/command/report_output.h"
#include "experiments/support/output_file.h"
#include "experiments/support/standard_streams.h"
#include "experiments/trials/experiment_run.h"
#include "experiments/trials/row_robots.h"
#include "experiments/trials/scenario_template.h"
#include "experiments/trials/sweep_report.h"
#include "experiments/trials/sweep_values.h"
#include "models/input/input_error.h"

namespace possibility::experiments {
namespace {

namespace fs = std::filesystem;

struct SweepOptions {
  ExperimentOptions experiment;
  std::string scenario_template;
  std::string parameter;
  std::string values;
};

std::string RowName(const std::string& parameter, double value) {
  return fmt::format("{}={:.12g}", parameter, value);
}

/// One value of the sweep: writes its scenarios and reads them.
class SweepScenarios {
 public:
  SweepScenarios(std::shared_ptr<const ScenarioTemplate> scenario_template, fs::path folder,
                 std::string parameter, double value)
      : template_(std::move(scenario_template)),
        folder_(std::move(folder)),
        parameter_(std::move(parameter)),
        value_(value) {}

  /// @throws InputError naming the template or the scenario made from it.
  std::shared_ptr<const models::Scenario> Load(std::uint64_t seed) const {
    const fs::path file = folder_ / fmt::format("{}_{}.yaml", RowName(parameter_, value_), seed);
    WriteOutput(file, template_->Instantiate({{parameter_, value_}}, seed, folder_));
    return std::make_shared<const models::Scenario>(models::LoadScenario(file));
  }

 private:
  std::shared_ptr<const ScenarioTemplate> template_;
  fs::path folder_;
  std::string parameter_;
  double value_;
};

void CheckParameter(const ScenarioTemplate& scenario_template, const std::string& name) {
  bool is_name = !name.empty() && std::isdigit(static_cast<unsigned char>(name.front())) == 0;
  for (const char c : name) {
    is_name = is_name && (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_');
  }
  if (!is_name) {
    throw InputError(fmt::format("--parameter: '{}' is not valid, expected a name", name));
  }
  if (scenario_template.Mentions(name)) return;
  throw InputError(fmt::format("--parameter: {} has no placeholder with '{}'",
                               scenario_template.file().string(), name));
}

std::vector<ExperimentRow> RowsOf(const SweepOptions& options, const ExperimentSettings& settings) {
  const auto scenario_template =
      std::make_shared<const ScenarioTemplate>(options.scenario_template);
  CheckParameter(*scenario_template, options.parameter);
  const fs::path folder = settings.out / "scenarios";
  const std::vector<double> values = ParseSweepValues("--values", options.values);
  PrepareOutputFolder("--out", folder);
  RowRobots robots(settings);
  const std::string experiment =
      fmt::format("sweep {} {}", scenario_template->file().stem().string(), options.parameter);
  std::vector<ExperimentRow> rows;
  for (const double value : values) {
    const SweepScenarios scenarios(scenario_template, folder, options.parameter, value);
    // Finds errors in the template before the work starts.
    const auto scenario = scenarios.Load(settings.first_seed);
    ExperimentRow row = robots.RowOf(experiment, RowName(options.parameter, value), *scenario,
                                     scenario_template->content_hash());
    models::CheckScenarioAgainstRobot(*scenario, *row.robot, {actions::kStepOver});
    row.scenario = [scenarios](std::uint64_t seed) { return scenarios.Load(seed); };
    row.parameter = options.parameter;
    row.value = value;
    rows.push_back(std::move(row));
  }
  return rows;
}

ExitCode RunSweep(const SweepOptions& options) {
  const ExperimentSettings settings = ParseExperimentOptions(
      options.experiment,
      fs::path("out") / ("sweep_" + fs::path(options.scenario_template).stem().string()));
  const std::vector<ExperimentRow> rows = RowsOf(options, settings);
  const SweepReport report{RunExperiment(rows, settings, settings.out / "results.jsonl", {})};
  if (report.trials.empty()) {
    PrintOut("{}", options.experiment.json ? "{}\n" : "no trial in this part of the sweep\n");
    return kDone;
  }
  PutOutReport(report, settings.out, options.experiment.json);
  return kDone;
}

}  // namespace

Command AddSweepCommand(CLI::App& program) {
  CommandOptions command(program, "sweep", "Success and time over a parameter of a scenario.");
  auto options = std::make_shared<SweepOptions>();
  command.AddRequired("TEMPLATE", &options->scenario_template,
                      "Scenario YAML with ${placeholders}");
  command.AddRequired("--parameter", &options->parameter, "Name in the placeholders");
  command.AddRequired("--values", &options->values, "FIRST:LAST:STEP, or numbers and commas");
  AddExperimentOptions(&options->experiment, &command);
  return {command, [options] { return RunSweep(*options); }};
}

}  // namespace possibility::experiments
