#pragma once

#include <string>

#include "actions/conditions/locomotion_model.h"
#include "models/robot/robot_model.h"
#include "models/robot/robot_yaml.h"

namespace possibility::actions {

/// A walker on four point feet.
inline const models::RobotModel& Quadruped() {
  static const models::RobotModel robot = models::LoadRobotModel(
      std::string(POSSIBILITY_SOURCE_DIR) + "/tests/models/quadruped/quadruped.yaml");
  return robot;
}

inline const LocomotionModel& QuadrupedLocomotion() {
  static const LocomotionModel model = BuildLocomotionModel(Quadruped(), {"walk"});
  return model;
}

}  // namespace possibility::actions
