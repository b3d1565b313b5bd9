#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "experiments/trials/experiment_run.h"
#include "models/robot/robot_model.h"
#include "models/world/scenario.h"

namespace possibility::experiments {

/// The robots of an experiment's scenarios, each loaded once.
class RowRobots {
 public:
  explicit RowRobots(const ExperimentSettings& settings) : settings_(settings) {}

  /// Name, identity and robot of a row. For a template, `scenario` is one of its instances.
  /// @throws InputError if the robot cannot be loaded.
  ExperimentRow RowOf(const std::string& experiment, const std::string& name,
                      const models::Scenario& scenario, const std::string& scenario_hash);

 private:
  struct Robot {
    std::shared_ptr<const models::RobotModel> model;
    std::string settings;  ///< hash; it depends on the robot's library
  };
  const Robot& Load(const std::filesystem::path& file);

  ExperimentSettings settings_;
  std::map<std::filesystem::path, Robot> robots_;
};

}  // namespace possibility::experiments
