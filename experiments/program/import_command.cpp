#include "experiments/program/import_command.h"

#include <filesystem>
#include <memory>
#include <string>

#include "actions/plan/plan_reader.h"
#include "actions/plan/plan_writer.h"
#include "actions/verify/verification_report.h"
#include "actions/verify/verifier.h"
#include "experiments/imports/imported_plan.h"
#include "experiments/imports/trajectory_reader.h"
#include "experiments/support/hardware_threads.h"
#include "experiments/support/output_file.h"
#include "experiments/support/standard_streams.h"
#include "models/robot/robot_yaml.h"
#include "models/world/scenario.h"

namespace possibility::experiments {
namespace {

struct ImportOptions {
  std::string trajectory;
  std::string robot;
  std::string scenario;
  std::string out;
  bool json = false;
};

ExitCode RunImport(const ImportOptions& options) {
  const models::Scenario scenario = models::LoadScenario(options.scenario);
  const std::filesystem::path robot_file =
      options.robot.empty() ? scenario.robot_file : std::filesystem::path(options.robot);
  const models::RobotModel robot = models::LoadRobotModel(robot_file);
  const ImportedTrajectory trajectory = ReadTrajectory(options.trajectory, robot);
  PrepareOutputFolder("--out", options.out);
  const std::filesystem::path file = std::filesystem::path(options.out) / "plan.json";
  actions::WritePlan(ImportPlan(trajectory, robot, scenario), file);

  actions::VerifierSettings settings;
  settings.threads = HardwareThreads();
  const actions::VerificationReport report =
      actions::Verify(actions::ReadPlan(file), robot, scenario, settings);
  if (options.json) {
    PrintOut("{}\n", actions::FormatJson(report));
  } else {
    PrintOut("{}{}\n", actions::FormatText(report), file.string());
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
  command.AddRequired("--out", &options->out, "Folder for plan.json");
  command.AddFlag("--json", &options->json, "Print one JSON object");
  return {command, [options] { return RunImport(*options); }};
}

}  // namespace possibility::experiments
