#include "actions/planner/request_checks.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "models/input/action_name.h"
#include "models/input/input_error.h"

namespace possibility::actions {
namespace {

std::string Describe(const models::Stance& stance) {
  return fmt::format("({:.3f}, {:.3f}, {:.3f}) heading {:.1f} deg", stance.x, stance.y, stance.z,
                     stance.yaw * 180 / EIGEN_PI);
}

}  // namespace

std::vector<std::string> FurtherNames(const std::vector<GaitFactory>& gaits,
                                      const std::vector<ManoeuvreFactory>& manoeuvres) {
  std::vector<std::string> names;
  for (const GaitFactory& factory : gaits) names.push_back(factory.name);
  for (const ManoeuvreFactory& factory : manoeuvres) names.push_back(factory.name);
  return names;
}

void RequireNewNames(const models::RobotModel& robot, const models::Scenario& scenario,
                     const std::vector<GaitFactory>& gaits,
                     const std::vector<ManoeuvreFactory>& manoeuvres) {
  std::vector<std::string> taken;
  for (const models::Jump& jump : robot.jumps) taken.push_back(jump.name);
  for (const models::Gait& gait : robot.gaits) taken.push_back(gait.name);
  for (const std::string& name : FurtherNames(gaits, manoeuvres)) {
    if (!models::IsActionName(name)) {
      throw InputError(fmt::format("{}: actions: an action is called {:?}, expected {}",
                                   scenario.file.string(), name, models::kActionNameRule));
    }
    if (std::find(taken.begin(), taken.end(), name) != taken.end()) {
      throw InputError(
          fmt::format("{}: actions: an action is called '{}', as another one of robot '{}' or "
                      "of this request is already",
                      scenario.file.string(), name, robot.name));
    }
    taken.push_back(name);
  }
}

GroundedStance CheckedStance(const models::Stance& stance, const std::string& key,
                             const models::Scenario& scenario, const LocomotionModel& model,
                             const std::vector<std::shared_ptr<QuasiStaticAction>>& gaits,
                             const std::vector<std::string>& names) {
  const std::string where = fmt::format("{}: {}", scenario.file.string(), key);
  const int gait = model.GaitIndex(stance.action);
  if (gait < 0) {
    throw InputError(fmt::format("{}.action: '{}' is not among the actions planned with ({})",
                                 where, stance.action, fmt::join(names, ", ")));
  }
  if (!scenario.environment.bounds.contains(Eigen::Vector2d(stance.x, stance.y))) {
    throw InputError(
        fmt::format("{}: {} lies outside environment.bounds", where, Describe(stance)));
  }
  const GroundedStance grounded{gait, {stance.x, stance.y, stance.yaw}, stance.z};
  switch (gaits[gait]->Examine(grounded)) {
    case StanceFault::kNone:
      return grounded;
    case StanceFault::kOutOfBounds:
      throw InputError(fmt::format("{}: the pelvis of {} at {} lies outside environment.bounds",
                                   where, stance.action, Describe(stance)));
    case StanceFault::kOffGround:
      throw InputError(fmt::format(
          "{}: the {} stance at {} is off the ground; every contact point must be on ground of "
          "height {:.3f}",
          where, stance.action, Describe(stance), stance.z));
    default:
      throw InputError(fmt::format(
          "{}: the {} stance at {} is in collision with '{}' (there must be room for the nominal "
          "posture)",
          where, stance.action, Describe(stance), gaits[gait]->FirstBlocker(grounded)));
  }
}

}  // namespace possibility::actions
