#pragma once

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "actions/conditions/locomotion_model.h"
#include "models/robot/robot_model.h"
#include "models/robot/robot_yaml.h"

namespace possibility::actions {

/// A robot of the folder models/ beside DRC-HUBO1, with its walk; loaded once per test program.
class ShippedRobot {
 public:
  explicit ShippedRobot(const std::string& name)
      : robot_(models::LoadRobotModel(std::filesystem::path(POSSIBILITY_SOURCE_DIR) / "models" /
                                      name / (name + ".yaml"))),
        model_(BuildLocomotionModel(robot_, {"walk"}, {}, Library())) {}
  ShippedRobot(const ShippedRobot&) = delete;

  const models::RobotModel& robot() const { return robot_; }
  const LocomotionModel& model() const { return model_; }
  std::filesystem::path Library() const { return robot_.file.parent_path() / "jumps"; }

 private:
  models::RobotModel robot_;
  LocomotionModel model_;
};

inline const ShippedRobot& RobotNamed(const std::string& name) {
  static std::map<std::string, std::unique_ptr<ShippedRobot>> robots;
  std::unique_ptr<ShippedRobot>& robot = robots[name];
  if (!robot) robot = std::make_unique<ShippedRobot>(name);
  return *robot;
}

/// The folders of models/ that hold a robot, but for DRC-HUBO1's.
inline std::vector<std::string> ShippedRobotNames() {
  std::vector<std::string> names;
  const std::filesystem::path models = std::filesystem::path(POSSIBILITY_SOURCE_DIR) / "models";
  for (const auto& entry : std::filesystem::directory_iterator(models)) {
    const std::string name = entry.path().filename().string();
    if (name != "drchubo1" && exists(entry.path() / (name + ".yaml"))) names.push_back(name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace possibility::actions
