#include "experiments/robots/robot_init.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "actions/gait/pace_library.h"
#include "actions/onboarding/gait_fit.h"
#include "actions/onboarding/gait_numbers.h"
#include "actions/onboarding/robot_draft.h"
#include "actions/onboarding/robot_yaml_writer.h"
#include "actions/plan/plan_writer.h"
#include "actions/planner/planner.h"
#include "experiments/mjcf/mjcf_robot.h"
#include "experiments/robots/seen_meshes.h"
#include "experiments/robots/winding_ways.h"
#include "experiments/support/file_name.h"
#include "experiments/support/hardware_threads.h"
#include "experiments/support/output_file.h"
#include "experiments/support/standard_streams.h"
#include "experiments/viewer/viewer_page.h"
#include "models/input/input_error.h"
#include "models/input/json_text.h"
#include "models/robot/robot_yaml.h"
#include "models/world/scenario.h"

namespace possibility::experiments {
namespace {

namespace fs = std::filesystem;
using actions::FitTrial;

constexpr double kWay = 8;         // lengths of the leg
constexpr double kEnough = 1.15;   // times the expected speed: the fit stops there
constexpr double kTimeLimit = 20;  // s, to plan

/// The robot's name, safe as a file name.
std::string SafeName(const fs::path& urdf) {
  const std::string name = SafeFileName(urdf.stem().string());
  return name.empty() ? "robot" : name;
}

class Init {
 public:
  explicit Init(const RobotInitOptions& options) : options_(options) {}

  ExitCode Run() {
    PrepareOutputFolder("--out", options_.out);
    draft_ = options_.is_mjcf
                 ? DraftOfMjcf()
                 : actions::DraftRobot(options_.urdf, options_.packages, options_.srdf);
    draft_.robot.name = SafeName(options_.urdf);
    if (!options_.is_mjcf) CopyWhatIsSeen();
    if (!options_.json) PrintFindings();
    std::vector<actions::FittedGait> fits = Fit();
    if (fits.empty()) return ReportNoWalk();
    // The verifier may refuse the quickest gait.
    for (std::size_t i = 0; i + 1 < fits.size(); ++i) {
      if (Plan(fits[i])) return Report(true);
    }
    return Report(Plan(fits.back()));
  }

 private:
  /// Restates the MJCF file in the robot's folder, and goes on from there.
  actions::RobotDraft DraftOfMjcf() const {
    const std::string name = SafeName(options_.urdf);
    const MjcfRobot robot = ReadMjcf(options_.urdf, name);
    for (const NamedBytes& file : robot.files) {
      const fs::path path = options_.out / file.name;
      PrepareOutputFolder("--out", path.parent_path());
      WriteOutput(path, file.bytes);
    }
    const fs::path urdf = options_.out / (name + ".urdf");
    WriteOutput(urdf, robot.urdf);
    std::optional<fs::path> srdf = options_.srdf;
    if (!srdf && !robot.srdf.empty()) {
      srdf = options_.out / (name + ".srdf");
      WriteOutput(*srdf, robot.srdf);
    }
    actions::RobotDraft draft = actions::DraftRobot(urdf, options_.packages, srdf);
    draft.findings.insert(draft.findings.begin(), robot.findings.begin(), robot.findings.end());
    return draft;
  }

  /// The copy of the URDF lies elsewhere, so it needs meshes of its own.
  void CopyWhatIsSeen() {
    SeenMeshes seen = CopySeenMeshes(draft_.urdf, draft_.urdf_file, options_.packages);
    draft_.urdf = std::move(seen.urdf);
    draft_.warnings.insert(draft_.warnings.end(), seen.warnings.begin(), seen.warnings.end());
    if (seen.files.empty()) return;
    PrepareOutputFolder("--out", options_.out / "meshes");
    for (const NamedBytes& file : seen.files) WriteOutput(options_.out / file.name, file.bytes);
    draft_.findings.push_back(fmt::format("looks: {} meshes of {} triangles, in meshes/",
                                          seen.files.size(), seen.triangles));
  }

  void PrintFindings() const {
    for (const std::string& finding : draft_.findings) PrintOut("{}\n", finding);
    for (const std::string& warning : draft_.warnings) PrintOut("warning: {}\n", warning);
  }

  std::vector<actions::FittedGait> Fit() {
    return actions::FitWalk(
        draft_, options_.fit_seconds, kEnough, &trials_,
        [](const FitTrial& trial) { PrintError("{}\n", actions::TextOf(trial)); });
  }

  ExitCode ReportNoWalk() const {
    const std::string reason = trials_.empty() ? "nothing tried" : trials_.front().reason;
    if (options_.json) {
      PrintOut("{}\n", models::JsonText(nlohmann::ordered_json{
                           {"status", "no_walk"}, {"trials", trials_.size()}, {"reason", reason}}));
    }
    PrintError("no walk: {} postures tried; the first: {}\n", trials_.size(), reason);
    return kNoPlan;
  }

  /// Writes the robot with this gait and plans its walk. Whether that is found and verified, and
  /// winding ways are.
  bool Plan(const actions::FittedGait& fitted) {
    gait_findings_ = FindingsOf(fitted);
    WriteFiles(fitted);
    const models::RobotModel robot = models::LoadRobotModel(RobotFile());
    const fs::path library = options_.out / "jumps";
    actions::PaceLibrary(robot, library).Save(robot.gaits.front(), fitted.paces);
    const models::Scenario scenario = models::LoadScenario(ScenarioFile());
    actions::PlanRequest request;
    request.threads = HardwareThreads();
    request.time_limit = kTimeLimit;
    request.library = library;
    result_ = actions::PlanTraversal(robot, scenario, request);
    const bool is_found = result_.status == actions::PlanStatus::kFound;
    if (!is_found || !result_.verification.accepted()) {
      return Refuse(fmt::format("{}: {}", actions::ToString(result_.status), result_.explanation));
    }
    winding_ = WalkWindingWays(robot, robot.gaits.front().name, library, draft_.leg_length);
    if (!winding_.AllVerified()) return Refuse(winding_.refusal);
    actions::WritePlan(result_.plan, options_.out / "plan.json");
    WriteOutput(options_.out / "plan.html", ViewerPage(result_.plan, robot, scenario));
    return true;
  }

  bool Refuse(const std::string& why) {
    refusal_ = why;
    PrintError("refused: {}\n", why);
    return false;
  }

  void WriteFiles(const actions::FittedGait& fitted) {
    actions::RobotDraft draft = draft_;
    draft.robot.gaits = {fitted.gait};
    draft.ignored = fitted.ignored;
    draft.findings.insert(draft.findings.end(), gait_findings_.begin(), gait_findings_.end());
    const std::string urdf = draft.robot.name + ".urdf";
    WriteOutput(options_.out / urdf, draft_.urdf);
    WriteOutput(RobotFile(), actions::RobotYaml(draft, urdf));
    WriteOutput(ScenarioFile(),
                actions::FlatScenarioYaml(draft.robot.name + "_flat", "robot.yaml",
                                          kWay * draft.leg_length, 2 * draft.leg_length));
  }

  std::vector<std::string> FindingsOf(const actions::FittedGait& fitted) const {
    const FitTrial& trial = fitted.trial;
    return {
        fmt::format(
            "stands with its hips at {:.2f} of the leg's length, soles {:.3f} m apart; '{}' "
            "bears {:.0f} % of its torque limit with the weight on one foot",
            trial.choice.extension, fitted.standing.sole_distance, fitted.standing.torque_joint,
            100 * fitted.standing.torque),
        fmt::format("{} pairs of links are not tested against each other: see ignored_collisions",
                    fitted.ignored.size()),
        fmt::format(
            "gait: scaled by the leg's length, quickness {:.2f}, one of {} trials; a quicker "
            "pace: {}",
            trial.quickness, trials_.size(), trial.binding)};
  }

  ExitCode Report(bool found) const {
    const double distance = kWay * draft_.leg_length;
    const double speed = found ? distance / result_.plan.duration() : 0;
    const double expected = actions::ExpectedSpeed(draft_);
    std::vector<std::string> findings = draft_.findings;
    findings.insert(findings.end(), gait_findings_.begin(), gait_findings_.end());
    if (options_.json) {
      PrintOut("{}\n", models::JsonText(
                           nlohmann::ordered_json{{"status", actions::ToString(result_.status)},
                                                  {"verified", found},
                                                  {"robot", RobotFile().string()},
                                                  {"scenario", ScenarioFile().string()},
                                                  {"leg_length", draft_.leg_length},
                                                  {"distance", distance},
                                                  {"speed", speed},
                                                  {"expected_speed", expected},
                                                  {"winding_ways", winding_.tried},
                                                  {"winding_ways_verified", winding_.verified},
                                                  {"findings", findings},
                                                  {"warnings", draft_.warnings}}));
    }
    if (!found) {
      PrintError("no walk: {}\n", refusal_);
      return kNoPlan;
    }
    if (options_.json) return kDone;
    for (const std::string& finding : gait_findings_) PrintOut("{}\n", finding);
    PrintOut(
        "walks {:.2f} m in {:.1f} s, verified: {:.2f} m/s (0.15 sqrt(g l) is {:.2f}); also {} "
        "winding "
        "ways\n{}\n{}\n",
        distance, result_.plan.duration(), speed, expected, winding_.verified, RobotFile().string(),
        (options_.out / "plan.html").string());
    return kDone;
  }

  fs::path RobotFile() const { return options_.out / "robot.yaml"; }
  fs::path ScenarioFile() const { return options_.out / "flat.yaml"; }

  const RobotInitOptions& options_;
  actions::RobotDraft draft_;
  std::vector<FitTrial> trials_;
  std::vector<std::string> gait_findings_;  ///< of the gait planned with last
  actions::PlanResult result_;
  WindingWays winding_;
  std::string refusal_;  ///< of the gait planned with last
};

}  // namespace

ExitCode InitRobot(const RobotInitOptions& options) { return Init(options).Run(); }

}  // namespace possibility::experiments
