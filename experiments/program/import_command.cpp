#include "experiments/program/import_command.h"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>

#include "actions/checks/plan_torques.h"
#include "actions/plan/plan_reader.h"
#include "actions/refinement/plan_refinement.h"
#include "actions/verify/verification_report.h"
#include "actions/verify/verifier.h"
#include "experiments/imports/imported_plan.h"
#include "experiments/imports/trajectory_reader.h"
#include "experiments/service/plan_output.h"
#include "experiments/support/hardware_threads.h"
#include "experiments/support/option_values.h"
#include "experiments/support/output_file.h"
#include "experiments/support/standard_streams.h"
#include "models/input/input_error.h"
#include "models/robot/robot_yaml.h"
#include "models/world/scenario.h"

namespace possibility::experiments {
namespace {

struct ImportOptions {
  std::string trajectory;
  std::string robot;
  std::string scenario;
  std::string out;
  std::string format;
  bool json = false;
};

/// @throws InputError naming the trajectory if its numbers cannot be packed.
actions::Plan Refined(const actions::Plan& plan, const models::RobotModel& robot,
                      const std::string& trajectory) {
  try {
    return actions::RefinedPlan(plan, robot);
  } catch (const std::invalid_argument& error) {
    throw InputError(fmt::format("{}: {}, expected a motion of finite numbers up to 1e6",
                                 trajectory, error.what()));
  }
}

ExitCode RunImport(const ImportOptions& options) {
  const int version =
      options.format.empty() ? 1 : static_cast<int>(ParseInteger("--format", options.format, 1, 2));
  const models::Scenario scenario = models::LoadScenario(options.scenario);
  const std::filesystem::path robot_file =
      options.robot.empty() ? scenario.robot_file : std::filesystem::path(options.robot);
  const models::RobotModel robot = models::LoadRobotModel(robot_file);
  const ImportedTrajectory trajectory = ReadTrajectory(options.trajectory, robot);
  PrepareOutputFolder("--out", options.out);
  const PlanFiles files = PlanFilesIn(options.out, version);
  actions::Plan plan = ImportPlan(trajectory, robot, scenario);
  if (version == 2) plan = Refined(plan, robot, options.trajectory);
  WriteOnlyPlan(plan, robot, files);

  actions::Plan written = actions::ReadPlan(files.plan);
  actions::CompleteTorques(robot, &written);
  actions::VerifierSettings settings;
  settings.threads = HardwareThreads();
  const actions::VerificationReport report = actions::Verify(written, robot, scenario, settings);
  if (options.json) {
    PrintOut("{}\n", actions::FormatJson(report));
  } else {
    PrintOut("{}{}\n", actions::FormatText(report), files.plan.string());
  }
  return report.accepted() ? kDone : kVerificationFailed;
}

}  // namespace

Command AddImportCommand(CLI::App& program) {
  CommandOptions command(program, "import", "Completes a motion made elsewhere, and verifies it.");
  auto options = std::make_shared<ImportOptions>();
  command.AddRequired("TRAJECTORY", &options->trajectory, "CSV table or .npz file");
  command.AddOptional("--robot", &options->robot, "Robot YAML (default: the scenario's)");
  command.AddRequired("--scenario", &options->scenario, "Scenario YAML");
  command.AddRequired("--out", &options->out, "Folder for the plan");
  command.AddOptional(
      "--format", &options->format,
      "1: plan.json (default); 2: plan.zip, a tenth as large and exact between knots");
  command.AddFlag("--json", &options->json, "Print one JSON object");
  return {command, [options] { return RunImport(*options); }};
}

}  // namespace possibility::experiments
