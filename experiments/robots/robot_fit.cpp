#include "experiments/robots/robot_fit.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <system_error>
#include <vector>

#include "actions/gait/pace_library.h"
#include "actions/onboarding/gait_fit.h"
#include "actions/onboarding/gait_numbers.h"
#include "actions/onboarding/refit_draft.h"
#include "actions/planner/planner.h"
#include "experiments/robots/scaled_scenes.h"
#include "experiments/robots/winding_ways.h"
#include "experiments/support/hardware_threads.h"
#include "experiments/support/standard_streams.h"
#include "models/input/atomic_file.h"
#include "models/input/file_contents.h"
#include "models/input/input_error.h"
#include "models/input/json_text.h"
#include "models/input/yaml_edit.h"
#include "models/robot/robot_yaml.h"

namespace possibility::experiments {
namespace {

namespace fs = std::filesystem;

constexpr double kLengthsOfWay = 8;  // of the leg
constexpr double kFitEnough = 1.15;  // times the expected speed: the fit stops there
constexpr double kPlanSeconds = 20;  // to plan
constexpr double kInDegrees = 180 / std::numbers::pi;

class Fit {
 public:
  explicit Fit(const RobotFitOptions& options)
      : options_(options),
        robot_(models::LoadRobotModel(options.robot)),
        draft_(actions::DraftToRefit(robot_, robot_.GaitNamed(options.gait))),
        distance_(kLengthsOfWay * draft_.leg_length) {}

  ExitCode Run() {
    const double before = SpeedOf(robot_);
    std::vector<actions::FitTrial> trials;
    const std::vector<actions::FittedGait> fits = actions::FitWalk(
        draft_, options_.fit_seconds, kFitEnough, &trials,
        [](const actions::FitTrial& trial) { PrintError("{}\n", actions::TextOf(trial)); });
    double after = 0;
    for (const actions::FittedGait& fitted : fits) {
      after = Try(fitted, before);
      if (after > before) break;
    }
    return Report(before, after);
  }

 private:
  /// Mean speed of the verified walk, m/s; 0 if there is none, or a winding way is refused.
  double SpeedOf(const models::RobotModel& robot) {
    actions::PlanRequest request;
    request.threads = HardwareThreads();
    request.time_limit = kPlanSeconds;
    request.library = Library();
    try {
      const actions::PlanResult result =
          actions::PlanTraversal(robot, FlatScene(robot, options_.gait, distance_), request);
      if (result.status != actions::PlanStatus::kFound || !result.verification.accepted()) {
        reason_ = result.explanation;
        return 0;
      }
      const WindingWays winding =
          WalkWindingWays(robot, options_.gait, Library(), draft_.leg_length);
      if (winding.AllVerified()) return distance_ / result.plan.duration();
      reason_ = winding.refusal;
    } catch (const InputError& error) {
      reason_ = error.what();
    }
    return 0;
  }

  /// The speed with a fitted gait. The file gets its numbers if that is above `least`.
  double Try(const actions::FittedGait& fitted, double least) {
    const std::string text = models::WithYamlEdits(models::ReadFileContents(options_.robot),
                                                   options_.robot, EditsFor(fitted.gait));
    // The numbers as the file will have them, beside the file: it names others by their paths.
    fs::path draft = options_.robot;
    draft.replace_extension(".fitted.yaml");
    models::WriteAtomically(draft, text);
    double speed = 0;
    try {
      const models::RobotModel robot = models::LoadRobotModel(draft);
      actions::PaceLibrary(robot, Library()).Save(robot.GaitNamed(options_.gait), fitted.paces);
      speed = SpeedOf(robot);
    } catch (const InputError& error) {
      reason_ = error.what();
    }
    std::error_code ignored;
    fs::remove(draft, ignored);
    if (speed > least) models::WriteAtomically(options_.robot, text);
    return speed;
  }

  std::vector<models::YamlEdit> EditsFor(const models::Gait& fitted) const {
    const models::Gait& gait = robot_.GaitNamed(options_.gait);
    const std::string index = std::to_string(&gait - robot_.gaits.data());
    std::vector<models::YamlEdit> edits;
    const auto set = [&](const std::string& part, const std::string& key, std::string value) {
      edits.push_back({{"gaits", index, part, key}, std::move(value)});
    };
    set("posture", "root_height", fmt::format("{:.9f}", fitted.posture.root_height));
    for (int i = 0; i < robot_.num_joints(); ++i) {
      const models::Joint& joint = robot_.joints[i];
      if (joint.mimic || fitted.posture.joints[i] == gait.posture.joints[i]) continue;
      const double unit = joint.type == models::JointType::kPrismatic ? 1 : kInDegrees;
      edits.push_back({{"gaits", index, "posture", "joints_deg", joint.name},
                       fmt::format("{:.9f}", fitted.posture.joints[i] * unit)});
    }
    const models::GaitParameters& p = fitted.parameters;
    for (const auto& [key, value] :
         {std::pair("forward", p.forward), std::pair("lateral", p.lateral),
          std::pair("turn_deg", p.turn * kInDegrees), std::pair("clearance", p.clearance),
          std::pair("com_margin", p.com_margin), std::pair("swing_time", p.swing_time),
          std::pair("com_acceleration", p.com_acceleration),
          std::pair("minimum_shift_time", p.minimum_shift_time)}) {
      set("parameters", key, fmt::format("{:.4g}", value));
    }
    return edits;
  }

  ExitCode Report(double before, double after) const {
    const bool is_better = after > before;
    const double expected = actions::ExpectedSpeed(draft_);
    if (options_.json) {
      PrintOut("{}\n", models::JsonText(nlohmann::ordered_json{{"robot", options_.robot.string()},
                                                               {"gait", options_.gait},
                                                               {"speed_before", before},
                                                               {"speed_fitted", after},
                                                               {"written", is_better},
                                                               {"expected_speed", expected}}));
    }
    if (!is_better && before == 0) {
      PrintError("no walk: {}\n", reason_);
      return kNoPlan;
    }
    if (options_.json) return kDone;
    PrintOut("before  {}\nfitted  {}\n{}: {} (0.15 sqrt(g l) is {:.2f} m/s)\n", Speed(before),
             Speed(after), options_.robot.string(), is_better ? "written" : "left as it was",
             expected);
    return kDone;
  }

  static std::string Speed(double speed) {
    return speed > 0 ? fmt::format("{:.2f} m/s, verified", speed) : "no verified walk";
  }

  fs::path Library() const { return options_.robot.parent_path() / "jumps"; }

  const RobotFitOptions& options_;
  const models::RobotModel robot_;
  const actions::RobotDraft draft_;
  const double distance_;
  std::string reason_ = "no posture fits";
};

}  // namespace

ExitCode FitRobot(const RobotFitOptions& options) { return Fit(options).Run(); }

}  // namespace possibility::experiments
