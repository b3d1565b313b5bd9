#include "experiments/robots/winding_ways.h"

#include <fmt/format.h>

#include <random>
#include <vector>

#include "actions/conditions/locomotion_model.h"
#include "actions/planner/route_refusals.h"
#include "actions/route/route_motion.h"
#include "actions/verify/verifier.h"
#include "actions/wholebody/planar_pose.h"
#include "common/run_on_threads.h"
#include "experiments/robots/scaled_scenes.h"
#include "experiments/support/hardware_threads.h"

namespace possibility::experiments {
namespace {

using actions::PlanarPose;

constexpr std::size_t kWays = 8;
constexpr int kLegs = 8;
/// Greatest displacements of a leg of a way: shares of the scale, and rad.
constexpr double kAhead = 0.6;
constexpr double kAside = 0.3;
constexpr double kTurn = 0.5;
/// Of the floor, in multiples of the scale: more than a way can reach.
constexpr double kExtent = 16;

std::vector<actions::Route> Ways(double scale) {
  std::mt19937 generator(1);
  // The standard's distributions differ between libraries.
  const auto between = [&](double bound) {
    return bound * (2.0 * generator() / std::mt19937::max() - 1);
  };
  std::vector<actions::Route> ways(kWays);
  for (actions::Route& way : ways) {
    PlanarPose at;
    for (int i = 0; i < kLegs; ++i) {
      actions::RouteLeg leg;
      leg.from = at;
      PlanarPose step;
      step.x = between(kAhead * scale);
      step.y = between(kAside * scale);
      step.yaw = between(kTurn);
      leg.to = at * step;
      at = leg.to;
      way.push_back(leg);
    }
  }
  return ways;
}

/// Why a way is not verified; empty if it is.
std::string Refusal(const actions::LocomotionModel& model, const models::Scenario& floor,
                    const actions::Route& way) {
  actions::Plan plan;
  plan.robot_hash = model.robot->content_hash;
  for (const models::Joint& joint : model.robot->joints) plan.joints.push_back(joint.name);
  try {
    plan.segments = actions::GenerateMotion(model, floor.environment, way, 1);
  } catch (const actions::MotionError& error) {
    return error.what();
  }
  models::Scenario scenario = floor;
  const PlanarPose& end = way.back().to;
  scenario.goals.front() = {floor.start.action, end.x, end.y, 0, end.yaw};
  const actions::VerificationReport report = Verify(plan, *model.robot, scenario);
  return report.accepted() ? "" : Describe(report.violations.front());
}

}  // namespace

WindingWays WalkWindingWays(const models::RobotModel& robot, const std::string& gait,
                            const std::filesystem::path& library, double scale) {
  const int threads = HardwareThreads();
  const actions::LocomotionModel model =
      actions::BuildLocomotionModel(robot, {gait}, {}, library, {}, threads);
  const models::Scenario floor = FlatScene(robot, gait, kExtent * scale);
  const std::vector<actions::Route> ways = Ways(scale);
  std::vector<std::string> refusals(ways.size());
  ForEachOnThreads(threads, ways.size(),
                   [&](std::size_t i) { refusals[i] = Refusal(model, floor, ways[i]); });
  WindingWays result;
  result.tried = static_cast<int>(ways.size());
  for (std::size_t i = 0; i < refusals.size(); ++i) {
    result.verified += refusals[i].empty();
    if (refusals[i].empty() || !result.refusal.empty()) continue;
    result.refusal = fmt::format("winding way {} of {}: {}", i + 1, ways.size(), refusals[i]);
  }
  return result;
}

}  // namespace possibility::experiments
