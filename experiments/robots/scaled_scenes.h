#pragma once

#include <string>

#include "models/robot/robot_model.h"
#include "models/world/scenario.h"

namespace possibility::experiments {

/// Scenes for a gait of a robot, made for its size. Lengths in m.

/// A level floor with the goal `distance` straight ahead.
models::Scenario FlatScene(const models::RobotModel& robot, const std::string& gait,
                           double distance);

/// A floor and steps up, the last of them a platform with the goal on it.
struct StepsUp {
  int count = 1;
  double height = 0;
  double depth = 0;
};
models::Scenario StepsScene(const models::RobotModel& robot, const std::string& gait,
                            const StepsUp& steps, double leg);

/// Two floors with a crack across the way.
models::Scenario CrackScene(const models::RobotModel& robot, const std::string& gait, double width,
                            double leg);

}  // namespace possibility::experiments
