#include "models/world/scenario.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "models/input/action_name.h"
#include "models/input/file_contents.h"
#include "models/input/input_error.h"
#include "models/input/nearest_name.h"
#include "models/input/yaml_reader.h"
#include "models/robot/robot_yaml.h"
#include "models/world/environment_yaml.h"

namespace possibility::models {
namespace {

Stance ReadStance(const YamlNode& node, const Scenario& scenario) {
  node.MapOf({"action", "x", "y", "z", "yaw_deg"});
  Stance stance;
  const YamlNode action = node.At("action");
  stance.action = action.String();
  const std::vector<std::string>& actions = scenario.actions;
  if (std::find(actions.begin(), actions.end(), stance.action) == actions.end()) {
    action.Fail(fmt::format("'{}' is not one of the scenario's actions{}", stance.action,
                            DidYouMean(stance.action, actions)));
  }
  stance.x = node.At("x").Number();
  stance.y = node.At("y").Number();
  if (!scenario.environment.bounds.contains(Eigen::Vector2d(stance.x, stance.y))) {
    node.Fail(fmt::format("({}, {}) lies outside environment.bounds", stance.x, stance.y));
  }
  if (const auto z = node.Find("z")) stance.z = z->Number();
  stance.yaw = node.At("yaw_deg").Degrees();
  return stance;
}

std::vector<Stance> ReadGoals(const YamlNode& root, const Scenario& scenario) {
  const auto goal = root.Find("goal");
  const auto goals = root.Find("goals");
  if (goal && goals) goals->Fail("expected either 'goal' or 'goals', got both");
  if (goal) return {ReadStance(*goal, scenario)};
  if (!goals) root.Fail("the key 'goal' (or 'goals') is missing");
  std::vector<Stance> stances;
  for (const YamlNode& node : goals->Items()) stances.push_back(ReadStance(node, scenario));
  if (stances.empty()) goals->FailExpected("at least one goal");
  return stances;
}

std::vector<std::string> ReadActions(const YamlNode& list) {
  std::vector<std::string> actions;
  for (const YamlNode& node : list.Items()) {
    const std::string action = ReadActionName(node);
    if (std::find(actions.begin(), actions.end(), action) != actions.end()) {
      node.Fail(fmt::format("action '{}' is listed twice", action));
    }
    actions.push_back(action);
  }
  if (actions.empty()) list.FailExpected("at least one action");
  return actions;
}

PlannerSettings ReadPlannerSettings(const YamlNode& node) {
  node.MapOf({"step", "rotation_weight", "max_transitions_per_cycle", "flood_after_cycles",
              "turns_after_floods", "flood_resolution", "skip_jumps", "improvement_share"});
  PlannerSettings settings;
  if (const auto step = node.Find("step")) settings.step = step->Number(0.001, 100);
  if (const auto weight = node.Find("rotation_weight")) {
    settings.rotation_weight = weight->Number(0.001, 0.999);
  }
  if (const auto count = node.Find("max_transitions_per_cycle")) {
    settings.max_transitions_per_cycle = static_cast<int>(count->Integer(1, 1000000));
  }
  if (const auto count = node.Find("flood_after_cycles")) {
    settings.flood_after_cycles = static_cast<int>(count->Integer(0, 1000000000));
  }
  if (const auto count = node.Find("turns_after_floods")) {
    settings.turns_after_floods = static_cast<int>(count->Integer(0, 1000000000));
  }
  if (const auto cell = node.Find("flood_resolution")) {
    settings.flood_resolution = cell->Number(0.005, 10);
  }
  if (const auto share = node.Find("improvement_share")) {
    settings.improvement_share = share->Number(0, 1);
  }
  if (const auto skip = node.Find("skip_jumps")) settings.skip_jumps = skip->Number(0, 1);
  return settings;
}

/// Empty if the robot's files are wrong: LoadRobotModel reports the error.
std::string HashOfRobot(const std::filesystem::path& file) {
  try {
    return RobotContentHash(file);
  } catch (const InputError&) {
    return {};
  }
}

constexpr double kLongestTimeLimit = 1e5;  // s

}  // namespace

Scenario LoadScenario(const std::filesystem::path& yaml_file) {
  const std::string text = ReadFileContents(yaml_file);
  const YamlNode root = YamlNode::Parse(text, yaml_file);
  root.MapOf({"name", "robot", "environment", "start", "goal", "goals", "actions", "planner",
              "time_limit", "seed"});
  Scenario scenario;
  scenario.name = root.At("name").String();
  scenario.file = yaml_file;
  scenario.robot_file = (yaml_file.parent_path() / root.At("robot").String()).lexically_normal();
  scenario.robot_hash = HashOfRobot(scenario.robot_file);
  std::vector<std::string> hashes = {text};
  scenario.environment = ReadEnvironment(root.At("environment"), yaml_file.parent_path(), &hashes);
  scenario.content_hash =
      hashes.size() == 1 ? ContentHash(text) : HashOfParts({hashes.begin(), hashes.end()});
  scenario.actions = ReadActions(root.At("actions"));
  scenario.start = ReadStance(root.At("start"), scenario);
  scenario.goals = ReadGoals(root, scenario);
  if (const auto planner = root.Find("planner")) scenario.planner = ReadPlannerSettings(*planner);
  if (const auto limit = root.Find("time_limit")) {
    limit->Positive();
    scenario.time_limit = limit->Number(0, kLongestTimeLimit);
  }
  if (const auto seed = root.Find("seed")) {
    scenario.seed = seed->Integer(0, std::numeric_limits<std::uint64_t>::max());
  }
  return scenario;
}

void CheckScenarioAgainstRobot(const Scenario& scenario, const RobotModel& robot,
                               const std::vector<std::string>& further) {
  if (!scenario.robot_hash.empty() && scenario.robot_hash != robot.content_hash) {
    throw InputError(fmt::format("{}: robot: names {}, expected the robot planned with, {}",
                                 scenario.file.string(), scenario.robot_file.string(),
                                 robot.file.string()));
  }
  CheckActionsOfRobot(scenario.actions, robot, scenario.file.string() + ": actions", further);
  const auto check = [&](const std::string& action, const std::string& key) {
    for (const Jump& jump : robot.jumps) {
      if (jump.name != action) continue;
      throw InputError(fmt::format("{}: {}: '{}' is a jump, expected a gait to stand in",
                                   scenario.file.string(), key, action));
    }
    if (std::find(further.begin(), further.end(), action) == further.end()) return;
    throw InputError(fmt::format("{}: {}: '{}' is not a gait, expected one to stand in",
                                 scenario.file.string(), key, action));
  };
  check(scenario.start.action, "start.action");
  for (const Stance& goal : scenario.goals) check(goal.action, "goal.action");
}

void CheckActionsOfRobot(const std::vector<std::string>& actions, const RobotModel& robot,
                         const std::string& where, const std::vector<std::string>& further) {
  std::vector<std::string> known = further;
  for (const Gait& gait : robot.gaits) known.push_back(gait.name);
  for (const Jump& jump : robot.jumps) known.push_back(jump.name);
  const auto contains = [](const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  for (const std::string& action : actions) {
    if (contains(known, action)) continue;
    throw InputError(fmt::format("{}: robot '{}' has no action '{}'{}", where, robot.name, action,
                                 DidYouMean(action, known)));
  }
  for (const Jump& jump : robot.jumps) {
    if (!contains(actions, jump.name)) continue;
    for (const std::string& gait : {jump.from, jump.to}) {
      if (contains(actions, gait)) continue;
      throw InputError(fmt::format("{}: '{}' jumps from '{}' to '{}', but '{}' is not among them",
                                   where, jump.name, jump.from, jump.to, gait));
    }
  }
}

}  // namespace possibility::models
