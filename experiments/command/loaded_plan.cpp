#include "experiments/command/loaded_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

#include "actions/checks/plan_torques.h"
#include "actions/plan/contact_name.h"
#include "actions/plan/plan_reader.h"
#include "models/input/input_error.h"
#include "models/robot/robot_yaml.h"

namespace possibility::experiments {
namespace {

bool Fits(const actions::Phase& phase, const models::RobotModel& robot, Eigen::Index num_points) {
  return phase.knots.size() >= 2 &&
         std::all_of(phase.knots.begin(), phase.knots.end(), [&](const actions::Knot& knot) {
           return knot.q.size() == robot.nq() && knot.v.size() == robot.nv() &&
                  knot.a.size() == robot.nv() && knot.tau.size() == robot.num_joints() &&
                  knot.forces.cols() == num_points;
         });
}

/// The plan, without robot and scenario.
LoadedPlan LoadAlone(const std::filesystem::path& file_or_directory) {
  LoadedPlan loaded;
  loaded.file = actions::PlanFileOf(file_or_directory);
  loaded.plan = actions::ReadPlan(loaded.file);
  return loaded;
}

/// @throws InputError if the plan names none: it is the motion of a library's jump.
void RequireScenario(const LoadedPlan& loaded) {
  if (!loaded.plan.scenario_file.empty()) return;
  throw InputError(fmt::format(
      "{}: scenario: file: empty, expected a scenario's path (of the motion of a library's jump, "
      "view the .json beside it)",
      loaded.file.string()));
}

}  // namespace

bool LoadedPlan::IsCurrent() const {
  return plan.robot_hash == robot.content_hash && plan.scenario_hash == scenario.content_hash;
}

LoadedPlan LoadPlan(const std::filesystem::path& file_or_directory) {
  LoadedPlan loaded = LoadAlone(file_or_directory);
  RequireScenario(loaded);
  loaded.scenario = models::LoadScenario(loaded.plan.scenario_file);
  loaded.robot = models::LoadRobotModel(loaded.plan.robot_file);
  actions::CompleteTorques(loaded.robot, &loaded.plan);
  return loaded;
}

LoadedPlan LoadPlanToVerify(const std::filesystem::path& file_or_directory,
                            const VerifiedWith& files) {
  LoadedPlan loaded = LoadAlone(file_or_directory);
  if (files.scenario.empty()) RequireScenario(loaded);
  loaded.scenario =
      models::LoadScenario(files.scenario.empty() ? loaded.plan.scenario_file : files.scenario);
  const std::filesystem::path& named = loaded.scenario.robot_file;
  std::error_code ignored;  // an unreadable path is reported when it is read
  if (files.robot.empty() && !std::filesystem::exists(named, ignored)) {
    throw InputError(fmt::format("{}: robot: no such file: {}, expected one, or --robot FILE",
                                 loaded.scenario.file.string(), named.string()));
  }
  loaded.robot = models::LoadRobotModel(files.robot.empty() ? named : files.robot);
  actions::CompleteTorques(loaded.robot, &loaded.plan);
  return loaded;
}

void RequireFit(const LoadedPlan& loaded) {
  for (std::size_t i = 0; i < loaded.plan.segments.size(); ++i) {
    for (const actions::Phase& phase : loaded.plan.segments[i].phases) {
      Eigen::Index num_points = 0;
      try {
        num_points = actions::CountPoints(loaded.robot, phase);
      } catch (const InputError& error) {
        throw InputError(
            fmt::format("{}: segments[{}]: {}", loaded.file.string(), i, error.what()));
      }
      if (Fits(phase, loaded.robot, num_points)) continue;
      throw InputError(fmt::format(
          "{}: segments[{}]: sizes do not fit the robot {}, expected {} joints and the forces of "
          "every contact point",
          loaded.file.string(), i, loaded.robot.file.string(), loaded.robot.num_joints()));
    }
  }
}

void RequireMotion(const LoadedPlan& loaded) {
  if (!loaded.plan.no) return;
  throw InputError(
      fmt::format("{}: no: the answer is \"no plan\" ({}), expected a plan with motion",
                  loaded.file.string(), loaded.plan.no->status));
}

}  // namespace possibility::experiments
