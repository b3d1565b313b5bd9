#include "experiments/robots/robot_command.h"

#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "actions/onboarding/robot_report.h"
#include "experiments/robots/robot_abilities.h"
#include "experiments/robots/robot_fit.h"
#include "experiments/robots/robot_init.h"
#include "experiments/support/option_values.h"
#include "experiments/support/standard_streams.h"
#include "models/input/input_error.h"
#include "models/input/json_text.h"
#include "models/robot/robot_yaml.h"

namespace possibility::experiments {
namespace {

struct RobotOptions {
  std::string what;
  std::string path;
  std::string srdf;
  std::vector<std::string> packages;
  std::string out;
  std::string gait = "walk";
  bool mjcf = false;
  std::string fit_seconds = "90";
  bool abilities = false;
  bool json = false;
};

ExitCode RunInit(const RobotOptions& options) {
  if (options.out.empty()) throw InputError("robot init: expected --out DIR");
  RobotInitOptions init;
  init.urdf = options.path;
  init.is_mjcf = options.mjcf;
  if (!options.srdf.empty()) init.srdf = options.srdf;
  for (const std::string& folder : options.packages) {
    if (!std::filesystem::is_directory(folder)) {
      throw InputError(fmt::format("--packages: '{}' is not a folder", folder));
    }
    init.packages.emplace_back(folder);
  }
  init.out = options.out;
  init.fit_seconds = ParseSeconds("--fit-seconds", options.fit_seconds);
  init.json = options.json;
  return InitRobot(init);
}

/// In a folder robot.yaml, or else the YAML that bears the folder's name; or the file itself.
std::filesystem::path RobotFileOf(const std::filesystem::path& path) {
  namespace fs = std::filesystem;
  if (!fs::is_directory(path)) return path;
  const fs::path named = path / (fs::canonical(path).filename().string() + ".yaml");
  const fs::path usual = path / "robot.yaml";
  return !fs::exists(usual) && fs::exists(named) ? named : usual;
}

ExitCode RunCheck(const RobotOptions& options) {
  const std::filesystem::path file = RobotFileOf(options.path);
  const models::RobotModel robot = models::LoadRobotModel(file);
  const std::filesystem::path library = file.parent_path() / "jumps";
  std::vector<actions::RobotFinding> findings = actions::ReportOn(robot, library);
  if (options.abilities) {
    const std::vector<actions::RobotFinding> more = AbilitiesOf(robot, library);
    findings.insert(findings.end(), more.begin(), more.end());
  }
  int faults = 0;
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const actions::RobotFinding& finding : findings) {
    faults += finding.is_fault;
    rows.push_back(
        {{"subject", finding.subject}, {"fault", finding.is_fault}, {"text", finding.text}});
    if (options.json) continue;
    PrintOut("{}{}: {}\n", finding.is_fault ? "FAULT " : "", finding.subject, finding.text);
  }
  if (options.json) {
    PrintOut("{}\n",
             models::JsonText(nlohmann::ordered_json{{"faults", faults}, {"findings", rows}}));
  }
  return faults == 0 ? kDone : kVerificationFailed;
}

ExitCode RunFit(const RobotOptions& options) {
  RobotFitOptions fit;
  fit.robot = RobotFileOf(options.path);
  fit.gait = options.gait;
  fit.fit_seconds = ParseSeconds("--fit-seconds", options.fit_seconds);
  fit.json = options.json;
  return FitRobot(fit);
}

ExitCode RunRobot(const RobotOptions& options) {
  if (options.what == "init") return RunInit(options);
  if (options.what == "check") return RunCheck(options);
  if (options.what == "fit") return RunFit(options);
  throw InputError(fmt::format("robot: expected init, check or fit, got '{}'", options.what));
}

}  // namespace

Command AddRobotCommand(CLI::App& program) {
  CommandOptions command(program, "robot",
                         "Makes a robot of a URDF (init X.urdf --out DIR), reports on one (check "
                         "DIR), fits its gait's "
                         "numbers again (fit DIR).");
  auto options = std::make_shared<RobotOptions>();
  command.AddRequired("WHAT", &options->what, "init, check or fit");
  command.AddRequired("PATH", &options->path,
                      "URDF; for check and fit: a robot's YAML or its folder");
  command.AddOptional("--srdf", &options->srdf, "SRDF: disabled collision pairs");
  command.AddFlag("--mjcf", &options->mjcf, "For init: the file is MJCF (needs MuJoCo)");
  command.AddOptional("--packages", &options->packages,
                      "Folder in which package:// is looked for as well");
  command.AddOptional("--out", &options->out, "Folder for the robot");
  command.AddOptional("--gait", &options->gait, "For fit: the gait on two feet");
  command.AddOptional("--fit-seconds", &options->fit_seconds, "s, for the gait's numbers");
  command.AddFlag("--abilities", &options->abilities,
                  "For check: plans walks, steps and a crack of the robot's size");
  command.AddFlag("--json", &options->json, "Print one JSON object");
  return {command, [options] { return RunRobot(*options); }};
}

}  // namespace possibility::experiments
