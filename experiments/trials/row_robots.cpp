#include "experiments/trials/row_robots.h"

#include "models/robot/robot_yaml.h"

namespace possibility::experiments {

ExperimentRow RowRobots::RowOf(const std::string& experiment, const std::string& name,
                               const models::Scenario& scenario, const std::string& scenario_hash) {
  const Robot& robot = Load(scenario.robot_file);
  ExperimentRow row;
  row.name = name;
  row.identity = {experiment, scenario_hash, robot.model->content_hash, robot.settings};
  row.robot = robot.model;
  return row;
}

const RowRobots::Robot& RowRobots::Load(const std::filesystem::path& file) {
  Robot& robot = robots_[file];
  if (!robot.model) {
    robot.model = std::make_shared<const models::RobotModel>(models::LoadRobotModel(file));
    robot.settings = settings_.Hash(LibraryOf(*robot.model));
  }
  return robot;
}

}  // namespace possibility::experiments
