#include "experiments/robots/robot_abilities.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "actions/onboarding/refit_draft.h"
#include "actions/planner/planner.h"
#include "experiments/robots/scaled_scenes.h"
#include "experiments/robots/winding_ways.h"
#include "experiments/support/hardware_threads.h"
#include "models/input/input_error.h"

namespace possibility::experiments {
namespace {

constexpr double kFlatWay = 8;       // lengths of the leg
constexpr double kStepHeight = 0.1;  // likewise
constexpr double kStepDepth = 0.4;
constexpr double kCrackWidth = 0.12;
constexpr double kSceneSeconds = 20;

/// Of the leg, m; of a gait on other than two feet the height of its root.
double ScaleOf(const models::RobotModel& robot, const models::Gait& gait) {
  try {
    return actions::DraftToRefit(robot, gait).leg_length;
  } catch (const InputError&) {
    return gait.posture.root_height;
  }
}

class AbilityTrial {
 public:
  AbilityTrial(const models::RobotModel& robot, const std::filesystem::path& library)
      : robot_(robot), library_(library) {}

  std::vector<actions::RobotFinding> Run() {
    for (const models::Gait& gait : robot_.gaits) TryGait(gait);
    const auto missing = [&](const char* kind, bool has) {
      Add(kind, has ? "in the file; not tried here" : "none in the file");
    };
    missing("transitions", !robot_.transitions.empty());
    missing("jumps and leaps", !robot_.jumps.empty());
    return std::move(findings_);
  }

 private:
  void Add(const std::string& subject, const std::string& text) {
    findings_.push_back({subject, text, false});
  }

  void TryGait(const models::Gait& gait) {
    const double leg = ScaleOf(robot_, gait);
    const StepsUp one{1, kStepHeight * leg, kStepDepth * leg};
    const StepsUp three{3, one.height, one.depth};
    const double width = kCrackWidth * leg;
    Try(gait.name + ": flat", FlatScene(robot_, gait.name, kFlatWay * leg));
    TryWindingWays(gait, leg);
    Try(fmt::format("{}: one step of {:.3f} m", gait.name, one.height),
        StepsScene(robot_, gait.name, one, leg));
    Try(fmt::format("{}: three steps of {:.3f} m by {:.2f} m", gait.name, three.height,
                    three.depth),
        StepsScene(robot_, gait.name, three, leg));
    Try(fmt::format("{}: crack of {:.3f} m", gait.name, width),
        CrackScene(robot_, gait.name, width, leg));
  }

  void TryWindingWays(const models::Gait& gait, double leg) {
    const std::string subject = gait.name + ": winding ways";
    try {
      const WindingWays ways = WalkWindingWays(robot_, gait.name, library_, leg);
      Add(subject, fmt::format("{} of {} verified{}{}", ways.verified, ways.tried,
                               ways.AllVerified() ? "" : ": ", ways.refusal));
    } catch (const InputError& error) {
      Add(subject, fmt::format("none: {}", error.what()));
    }
  }

  void Try(const std::string& subject, const models::Scenario& scenario) {
    actions::PlanRequest request;
    request.threads = HardwareThreads();
    request.time_limit = kSceneSeconds;
    request.library = library_;
    try {
      const actions::PlanResult result = actions::PlanTraversal(robot_, scenario, request);
      const bool found =
          result.status == actions::PlanStatus::kFound && result.verification.accepted();
      const models::Stance& goal = scenario.goals.front();
      const double way = std::hypot(goal.x - scenario.start.x, goal.z - scenario.start.z);
      Add(subject, found ? fmt::format("{:.2f} m/s, verified", way / result.plan.duration())
                         : fmt::format("no plan: {}: {}", actions::ToString(result.status),
                                       result.explanation));
    } catch (const InputError& error) {
      Add(subject, fmt::format("no plan: {}", error.what()));
    }
  }

  const models::RobotModel& robot_;
  const std::filesystem::path& library_;
  std::vector<actions::RobotFinding> findings_;
};

}  // namespace

std::vector<actions::RobotFinding> AbilitiesOf(const models::RobotModel& robot,
                                               const std::filesystem::path& library) {
  return AbilityTrial(robot, library).Run();
}

}  // namespace possibility::experiments
