#pragma once

#include <filesystem>
#include <string>

#include "actions/conditions/locomotion_model.h"
#include "models/robot/robot_model.h"
#include "models/robot/robot_yaml.h"
#include "models/world/scenario.h"

namespace possibility::actions {

/// The shipped robot, loaded once per test program.
inline const models::RobotModel& DrcHubo1() {
  static const models::RobotModel robot = models::LoadRobotModel(
      std::string(POSSIBILITY_SOURCE_DIR) + "/models/drchubo1/drchubo1.yaml");
  return robot;
}

/// The library that is shipped with it.
inline std::filesystem::path DrcHubo1Library() { return DrcHubo1().file.parent_path() / "jumps"; }

/// Its walking, crawling and transitions.
inline const LocomotionModel& DrcHubo1Locomotion() {
  static const LocomotionModel model =
      BuildLocomotionModel(DrcHubo1(), {"walk", "crawl"}, {}, DrcHubo1Library());
  return model;
}

/// Its walking alone.
inline LocomotionModel DrcHubo1Walking() {
  return BuildLocomotionModel(DrcHubo1(), {"walk"}, {}, DrcHubo1Library());
}

inline models::Scenario ShippedScenario(const std::string& name) {
  return models::LoadScenario(std::string(POSSIBILITY_SOURCE_DIR) + "/experiments/scenarios/" +
                              name + ".yaml");
}

}  // namespace possibility::actions
