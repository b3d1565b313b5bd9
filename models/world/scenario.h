#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "models/robot/robot_model.h"
#include "models/world/environment.h"

namespace possibility::models {

/// A stance on the ground: footprint frame of an action's nominal posture.
struct Stance {
  std::string action = "walk";
  double x = 0;    ///< m
  double y = 0;    ///< m
  double z = 0;    ///< m, height of the ground
  double yaw = 0;  ///< rad
};

struct PlannerSettings {
  double step = 0.25;                 ///< longest step of ExtendTowards, weighted metric, m
  double rotation_weight = 0.137;     ///< weight of an angle (rad); 1 - weight for a metre
  int max_transitions_per_cycle = 5;  ///< Algorithm 2
  int flood_after_cycles = 200;       ///< exploration cycles before asking whether a route exists
  /// Turns of random exploration where the floods cannot tell and contact planning has ended.
  int turns_after_floods = 20000;
  /// Share of the time limit for the search for a quicker route than the first.
  double improvement_share = 0.1;
  double flood_resolution = 0.1;  ///< m, cell size of the flood that checks this
  double skip_jumps = 0.9;        ///< probability that a cycle does not grow jumps (paper: 0.9)
};

/// What to plan: robot, world, start, goals, actions and settings.
struct Scenario {
  std::string name;
  std::filesystem::path file;
  std::string content_hash;          ///< of the YAML's bytes and the files of its terrain
  std::filesystem::path robot_file;  ///< resolved against the scenario's folder
  /// RobotModel::content_hash of that robot; empty if its files cannot be read.
  std::string robot_hash;
  Environment environment;
  Stance start;
  std::vector<Stance> goals;
  std::vector<std::string> actions;  ///< in the order of exploration
  PlannerSettings planner;
  double time_limit = 60;  ///< s
  std::uint64_t seed = 1;
};

/// @throws InputError for anything malformed (see docs/file_formats.md).
Scenario LoadScenario(const std::filesystem::path& yaml_file);

/// Checks a scenario against its robot. The robot is the one that the scenario names (unless
/// robot_hash is empty). Every action is a gait of the robot, a jump between two gaits that are
/// also among the actions, or one of `further`, actions that do not come from the robot. Start and
/// goals are gaits.
/// @throws InputError naming the scenario, and the action and the nearest known name.
void CheckScenarioAgainstRobot(const Scenario& scenario, const RobotModel& robot,
                               const std::vector<std::string>& further = {});

/// The part of that check on a list of actions. `where`: prefix of the message.
/// @throws InputError.
void CheckActionsOfRobot(const std::vector<std::string>& actions, const RobotModel& robot,
                         const std::string& where, const std::vector<std::string>& further = {});

}  // namespace possibility::models
