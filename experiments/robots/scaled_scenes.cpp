#include "experiments/robots/scaled_scenes.h"

#include <fmt/format.h>

namespace possibility::experiments {
namespace {

constexpr double kThickness = 0.5;  // m, of floors

/// From x = `from` to `to`, its top at `z`.
void AddFloor(const std::string& name, double from, double to, double width, double z,
              models::Scenario* scenario) {
  models::Obstacle floor;
  floor.name = name;
  floor.is_ground = true;
  floor.shape = models::Shape::Box({to - from, width, kThickness});
  floor.X_WO.translation() << (from + to) / 2, 0, z - kThickness / 2;
  scenario->environment.obstacles.push_back(floor);
}

models::Scenario Scene(const std::string& name, const models::RobotModel& robot,
                       const std::string& gait, double from, double to, double width) {
  models::Scenario scenario;
  scenario.name = name;
  scenario.file = name + ".yaml";
  scenario.robot_file = robot.file;
  scenario.actions = {gait};
  scenario.environment.bounds =
      Eigen::AlignedBox2d(Eigen::Vector2d(from, -width / 2), Eigen::Vector2d(to, width / 2));
  return scenario;
}

}  // namespace

models::Scenario FlatScene(const models::RobotModel& robot, const std::string& gait,
                           double distance) {
  const double beyond = 0.4 * distance;
  models::Scenario scenario = Scene("flat", robot, gait, -beyond, distance + beyond, 2 * beyond);
  scenario.start = {gait, 0, 0, 0, 0};
  scenario.goals = {{gait, distance, 0, 0, 0}};
  AddFloor("floor", -2 * beyond, distance + 2 * beyond, 3 * beyond, 0, &scenario);
  return scenario;
}

models::Scenario StepsScene(const models::RobotModel& robot, const std::string& gait,
                            const StepsUp& steps, double leg) {
  const double top = (steps.count - 1) * steps.depth;
  models::Scenario scenario = Scene("steps", robot, gait, -3 * leg, top + 3 * leg, 2.5 * leg);
  scenario.start = {gait, -leg, 0, 0, 0};
  scenario.goals = {{gait, top + leg, 0, steps.count * steps.height, 0}};
  AddFloor("floor", -4 * leg, 0, 3 * leg, 0, &scenario);
  for (int i = 1; i <= steps.count; ++i) {
    const double to = i == steps.count ? top + 4 * leg : i * steps.depth;
    AddFloor(fmt::format("step_{}", i), (i - 1) * steps.depth, to, 3 * leg, i * steps.height,
             &scenario);
  }
  return scenario;
}

models::Scenario CrackScene(const models::RobotModel& robot, const std::string& gait, double width,
                            double leg) {
  models::Scenario scenario = Scene("crack", robot, gait, -3 * leg, 3 * leg, 2.5 * leg);
  scenario.start = {gait, -leg, 0, 0, 0};
  scenario.goals = {{gait, leg + width, 0, 0, 0}};
  AddFloor("near_side", -4 * leg, 0, 3 * leg, 0, &scenario);
  AddFloor("far_side", width, 4 * leg, 3 * leg, 0, &scenario);
  return scenario;
}

}  // namespace possibility::experiments
