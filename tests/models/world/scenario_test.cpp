#include "models/world/scenario.h"

#include <gtest/gtest.h>

#include <cmath>

#include "models/input/input_error.h"
#include "models/robot/robot_model.h"
#include "models/robot/robot_yaml.h"
#include "tests/models/temporary_folder.h"
#include "tests/models/two_legged_robot.h"
#include "tests/replaced.h"

namespace possibility::models {
namespace {

const std::string kScenario = R"(name: room
robot: robots/robot.yaml
actions: [stand, squat]
start: {action: stand, x: 1, y: 2, yaw_deg: 90}
goals:
  - {action: squat, x: 3, y: 2, z: 0.5, yaw_deg: 0}
time_limit: 5
seed: 18446744073709551615
planner: {step: 0.5, rotation_weight: 0.2, max_transitions_per_cycle: 3, flood_resolution: 0.2}
environment:
  bounds: {x: [0, 4], y: [-1, 5]}
  ground:
    - {name: floor, size: [4, 6, 0.5], position: [2, 2, -0.25], yaw_deg: 90}
  obstacles:
    - {name: crate, shape: box, size: [1, 2, 3], position: [1, 0, 0], rpy_deg: [0, 90, 0]}
    - {name: bar, shape: cylinder, radius: 0.1, length: 2, position: [2, 0, 1], rpy_deg: [90, 0, 0]}
    - {name: ball, shape: sphere, radius: 0.3, position: [0, 0, 1]}
    - {name: pill, shape: capsule, radius: 0.3, length: 0.4, position: [0, 0, 1]}
    - {name: wedge, shape: convex, vertices: [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]}
)";

/// The scenario names its robot by a path. The content of the files there counts.
TEST(ScenarioYaml, ARobotOfAnotherContentIsRefused) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.Write("room.yaml", kScenario);
  EXPECT_EQ(LoadScenario(file).robot_hash, "");
  std::filesystem::create_directories(folder.path() / "robots");
  folder.Write("robots/robot.urdf", TwoLeggedUrdf());
  folder.Write("robots/robot.yaml", TwoLeggedYaml());
  const Scenario scenario = LoadScenario(file);
  const RobotModel robot = LoadRobotModel(scenario.robot_file);
  EXPECT_EQ(scenario.robot_hash, robot.content_hash);
  EXPECT_NO_THROW(CheckScenarioAgainstRobot(scenario, robot));

  folder.Write("robots/lighter.urdf",
               Replaced(TwoLeggedUrdf(), "mass value=\"2\"", "mass value=\"1.9\""));
  folder.Write("robots/lighter.yaml", Replaced(TwoLeggedYaml(), "robot.urdf", "lighter.urdf"));
  const RobotModel lighter = LoadRobotModel(folder.path() / "robots/lighter.yaml");
  EXPECT_THROW(CheckScenarioAgainstRobot(scenario, lighter), InputError);
}

TEST(ScenarioYaml, ReadsTheScenario) {
  const TemporaryFolder folder;
  const Scenario scenario = LoadScenario(folder.Write("room.yaml", kScenario));
  EXPECT_EQ(scenario.name, "room");
  EXPECT_EQ(scenario.robot_file, folder.path() / "robots/robot.yaml");
  EXPECT_EQ(scenario.actions, (std::vector<std::string>{"stand", "squat"}));
  EXPECT_EQ(scenario.start.action, "stand");
  EXPECT_NEAR(scenario.start.yaw, M_PI / 2, 1e-15);
  ASSERT_EQ(scenario.goals.size(), 1u);
  EXPECT_EQ(scenario.goals[0].z, 0.5);
  EXPECT_EQ(scenario.time_limit, 5);
  EXPECT_EQ(scenario.seed, 18446744073709551615u);
  EXPECT_EQ(scenario.planner.step, 0.5);
  EXPECT_EQ(scenario.planner.rotation_weight, 0.2);
  EXPECT_EQ(scenario.planner.max_transitions_per_cycle, 3);
  EXPECT_EQ(scenario.planner.flood_after_cycles, PlannerSettings().flood_after_cycles);
  EXPECT_EQ(scenario.planner.flood_resolution, 0.2);
  EXPECT_EQ(scenario.content_hash.size(), 32u);
}

TEST(ScenarioYaml, ReadsTheEnvironment) {
  const TemporaryFolder folder;
  const Environment environment = LoadScenario(folder.Write("room.yaml", kScenario)).environment;
  EXPECT_EQ(environment.bounds.min(), Eigen::Vector2d(0, -1));
  EXPECT_EQ(environment.bounds.max(), Eigen::Vector2d(4, 5));
  ASSERT_EQ(environment.obstacles.size(), 6u);
  const Obstacle& floor = environment.obstacles[0];
  EXPECT_TRUE(floor.is_ground);
  EXPECT_TRUE((floor.X_WO * Eigen::Vector3d(2, 0, 0.25)).isApprox(Eigen::Vector3d(2, 4, 0)));
  const Obstacle& crate = environment.obstacles[1];
  EXPECT_FALSE(crate.is_ground);
  EXPECT_EQ(crate.shape.size, Eigen::Vector3d(1, 2, 3));
  // Pitched by 90 degrees, its z axis points along x.
  EXPECT_TRUE((crate.X_WO * Eigen::Vector3d(0, 0, 1.5)).isApprox(Eigen::Vector3d(2.5, 0, 0)));
  EXPECT_EQ(environment.obstacles[2].shape.type, ShapeType::kCylinder);
  EXPECT_EQ(environment.obstacles[2].shape.length, 2);
  EXPECT_EQ(environment.obstacles[3].shape.type, ShapeType::kSphere);
  EXPECT_EQ(environment.obstacles[4].shape.type, ShapeType::kCapsule);
  EXPECT_EQ(environment.obstacles[5].shape.vertices.size(), 4u);
}

TEST(ScenarioYaml, ReadsFrictionAndWhatBears) {
  const TemporaryFolder folder;
  std::string text =
      Replaced(kScenario, "yaw_deg: 90}\n  obstacles", "yaw_deg: 90, friction: 0.3}\n  obstacles");
  text = Replaced(text, "name: crate,", "name: crate, bears: true, friction: 0.4,");
  const Environment environment = LoadScenario(folder.Write("room.yaml", text)).environment;
  EXPECT_EQ(environment.obstacles[0].friction, 0.3);
  EXPECT_FALSE(environment.obstacles[0].is_for_steps);
  EXPECT_TRUE(environment.obstacles[1].is_ground);
  EXPECT_TRUE(environment.obstacles[1].is_for_steps);
  EXPECT_EQ(environment.obstacles[1].friction, 0.4);
  EXPECT_EQ(environment.obstacles[2].friction, kRobotsFriction);
}

TEST(ScenarioYaml, ChecksActionsAgainstTheRobot) {
  const TemporaryFolder folder;
  folder.Write("robot.urdf", TwoLeggedUrdf());
  const RobotModel robot = LoadRobotModel(folder.Write("robot.yaml", TwoLeggedYaml()));
  Scenario scenario = LoadScenario(folder.Write("room.yaml", kScenario));
  EXPECT_NO_THROW(CheckScenarioAgainstRobot(scenario, robot));
  scenario.file = "room.yaml";
  scenario.actions.push_back("stnad");
  try {
    CheckScenarioAgainstRobot(scenario, robot);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "room.yaml: actions: robot 'two_legged' has no action 'stnad' (did you mean "
                 "'stand'?)");
  }
}

TEST(ScenarioYaml, ThreeRoutesFitTheRobot) {
  const std::string source = POSSIBILITY_SOURCE_DIR;
  for (const std::string letter : {"a", "b"}) {
    const Scenario scenario =
        LoadScenario(source + "/experiments/scenarios/three_routes_" + letter + ".yaml");
    EXPECT_EQ(scenario.environment.obstacles.size(), letter == "a" ? 13u : 16u);
    EXPECT_NO_THROW(CheckScenarioAgainstRobot(scenario, LoadRobotModel(scenario.robot_file)));
  }
}

std::string ErrorOfActions(const std::vector<std::string>& actions) {
  RobotModel robot;
  robot.name = "robot";
  for (const std::string name : {"stand", "squat"}) {
    robot.gaits.emplace_back();
    robot.gaits.back().name = name;
  }
  robot.jumps = {{"leap", "stand", "squat"}};
  try {
    CheckActionsOfRobot(actions, robot, "here");
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

TEST(ScenarioYaml, AJumpNeedsBothOfItsGaits) {
  EXPECT_EQ(ErrorOfActions({"stand", "leap", "squat"}), "");
  EXPECT_EQ(ErrorOfActions({"stand", "leap"}),
            "here: 'leap' jumps from 'stand' to 'squat', but 'squat' is not among them");
  EXPECT_EQ(ErrorOfActions({"stand", "leep"}),
            "here: robot 'robot' has no action 'leep' (did you mean 'leap'?)");
}

TEST(ScenarioYaml, JumpingScenariosFitTheRobot) {
  const std::string source = POSSIBILITY_SOURCE_DIR;
  for (const std::string name : {"three_routes_c", "hallway", "double_jump"}) {
    for (const std::string twin : {"", "_infeasible"}) {
      const Scenario scenario =
          LoadScenario(source + "/experiments/scenarios/" + name + twin + ".yaml");
      EXPECT_NO_THROW(CheckScenarioAgainstRobot(scenario, LoadRobotModel(scenario.robot_file)));
    }
  }
}

struct BadScenario {
  std::string what;
  std::string from;  ///< replaced once, at its first occurrence
  std::string to;
  std::string message;  ///< without the folder
};

class ScenarioErrors : public ::testing::TestWithParam<BadScenario> {};

TEST_P(ScenarioErrors, EachFaultIsNamedInOneLine) {
  const BadScenario& bad = GetParam();
  const TemporaryFolder folder;
  const std::filesystem::path file =
      folder.Write("room.yaml", Replaced(kScenario, bad.from, bad.to));
  std::string message = "no error";
  try {
    LoadScenario(file);
  } catch (const InputError& error) {
    message = error.what();
    const std::string prefix = folder.path().string() + "/";
    if (message.starts_with(prefix)) message.erase(0, prefix.size());
  }
  EXPECT_EQ(message, bad.message);
}

const BadScenario kBad[] = {
    {"Empty", kScenario, "", "room.yaml: expected a YAML map, got nothing"},
    {"SyntaxError", "bounds: {x: [0, 4],", "bounds: {x: [0, 4",
     "room.yaml:11: not valid YAML: illegal flow end"},
    {"UnknownKey", "time_limit: 5", "timelimit: 5",
     "room.yaml:7: unknown key 'timelimit' (did you mean 'time_limit'?)"},
    {"UnknownPlannerKey", "flood_resolution", "flod_resolution",
     "room.yaml:9: planner: unknown key 'flod_resolution' (did you mean 'flood_resolution'?)"},
    {"MissingRobot", "robot: robots/robot.yaml\n", "", "room.yaml:1: the key 'robot' is missing"},
    {"NoActions", "[stand, squat]", "[]",
     "room.yaml:3: actions: expected at least one action, got an empty list"},
    {"ActionTwice", "[stand, squat]", "[stand, stand]",
     "room.yaml:3: actions[1]: action 'stand' is listed twice"},
    {"ActionWithMarkup", "[stand, squat]", "[stand, '<b>']",
     "room.yaml:3: actions[1]: expected a name of at most 64 letters, digits, '_' and '-' that "
     "begins with a letter, got <b>"},
    {"ActionThatIsAPath", "[stand, squat]", "[../stand, squat]",
     "room.yaml:3: actions[0]: expected a name of at most 64 letters, digits, '_' and '-' that "
     "begins with a letter, got ../stand"},
    {"StartActionUnknown", "start: {action: stand", "start: {action: stan",
     "room.yaml:4: start.action: 'stan' is not one of the scenario's actions (did you mean "
     "'stand'?)"},
    {"StartMissesYaw", ", yaw_deg: 90}\ngoals", "}\ngoals",
     "room.yaml:4: start: the key 'yaw_deg' is missing"},
    {"StartOutside", "x: 1, y: 2", "x: -1, y: 2",
     "room.yaml:4: start: (-1, 2) lies outside environment.bounds"},
    {"StartNaN", "x: 1, y: 2", "x: nan, y: 2",
     "room.yaml:4: start.x: expected a finite number, got nan"},
    {"GoalOutside", "x: 3, y: 2", "x: 3, y: 20",
     "room.yaml:6: goals[0]: (3, 20) lies outside environment.bounds"},
    {"BoundsTooFar", "x: [0, 4]", "x: [0, 100001]",
     "room.yaml:11: environment.bounds.x: lies more than 100 km from the origin, expected "
     "coordinates between -100000 and 100000 m"},
    {"CrateTooFar", "position: [1, 0, 0]", "position: [1, 0, -100001]",
     "room.yaml:15: environment.obstacles[0]: lies more than 100 km from the origin, expected "
     "coordinates between -100000 and 100000 m"},
    {"FloorTooLarge", "size: [4, 6, 0.5]", "size: [4, 3e5, 0.5]",
     "room.yaml:13: environment.ground[0]: lies more than 100 km from the origin, expected "
     "coordinates between -100000 and 100000 m"},
    {"GoalAndGoals", "goals:", "goal: {action: stand, x: 1, y: 2, yaw_deg: 0}\ngoals:",
     "room.yaml:7: goals: expected either 'goal' or 'goals', got both"},
    {"NoGoal", "goals:\n  - {action: squat, x: 3, y: 2, z: 0.5, yaw_deg: 0}\n", "",
     "room.yaml:1: the key 'goal' (or 'goals') is missing"},
    {"GoalsEmpty", "goals:\n  - {action: squat, x: 3, y: 2, z: 0.5, yaw_deg: 0}\n", "goals: []\n",
     "room.yaml:5: goals: expected at least one goal, got an empty list"},
    {"TimeLimitZero", "time_limit: 5", "time_limit: 0",
     "room.yaml:7: time_limit: expected a positive number, got 0"},
    {"TimeLimitHuge", "time_limit: 5", "time_limit: 200000",
     "room.yaml:7: time_limit: expected a number from 0 to 100000, got 200000"},
    {"SeedNegative", "seed: 18446744073709551615", "seed: -1",
     "room.yaml:8: seed: expected a whole number from 0 to 18446744073709551615, got -1"},
    {"SeedTooLarge", "seed: 18446744073709551615", "seed: 18446744073709551616",
     "room.yaml:8: seed: expected a whole number from 0 to 18446744073709551615, got "
     "18446744073709551616"},
    {"SeedFraction", "seed: 18446744073709551615", "seed: 1.5",
     "room.yaml:8: seed: expected a whole number from 0 to 18446744073709551615, got 1.5"},
    {"StepZero", "step: 0.5", "step: 0",
     "room.yaml:9: planner.step: expected a number from 0.001 to 100, got 0"},
    {"WeightAboveOne", "rotation_weight: 0.2", "rotation_weight: 1.2",
     "room.yaml:9: planner.rotation_weight: expected a number from 0.001 to 0.999, got 1.2"},
    {"SkipJumpsAboveOne", "rotation_weight: 0.2", "skip_jumps: 1.2",
     "room.yaml:9: planner.skip_jumps: expected a number from 0 to 1, got 1.2"},
    {"TransitionsZero", "max_transitions_per_cycle: 3", "max_transitions_per_cycle: 0",
     "room.yaml:9: planner.max_transitions_per_cycle: expected a whole number from 1 to 1000000, "
     "got 0"},
    {"BoundsReversed", "x: [0, 4]", "x: [4, 0]",
     "room.yaml:11: environment.bounds.x: expected [lowest, highest], got [4, 0]"},
    {"BoundsShort", "x: [0, 4]", "x: [0]",
     "room.yaml:11: environment.bounds.x: expected [lowest, highest], got a list of 1"},
    {"GroundPitch", "yaw_deg: 90}\n  obstacles", "pitch_deg: 10}\n  obstacles",
     "room.yaml:13: environment.ground[0]: unknown key 'pitch_deg'"},
    {"GroundTurnedTwice", "yaw_deg: 90}\n  obstacles",
     "yaw_deg: 90, rpy_deg: [0, 10, 0]}\n  obstacles",
     "room.yaml:13: environment.ground[0].rpy_deg: expected either rpy_deg or yaw_deg, got both"},
    {"GroundOnACorner", "yaw_deg: 90}\n  obstacles", "rpy_deg: [45, 35.26, 0]}\n  obstacles",
     "room.yaml:13: environment.ground[0].rpy_deg: no side of the box faces up, expected one that "
     "is "
     "tilted by at most 45 degrees"},
    {"GroundFrictionZero", "yaw_deg: 90}\n  obstacles", "yaw_deg: 90, friction: 0}\n  obstacles",
     "room.yaml:13: environment.ground[0].friction: expected a positive number, got 0"},
    {"FrictionOfAnObstacle", "name: crate,", "name: crate, friction: 0.5,",
     "room.yaml:15: environment.obstacles[0].friction: is of an obstacle that does not bear, "
     "expected 'bears: true' beside it"},
    {"RoundObstacleThatBears", "shape: sphere,", "shape: sphere, bears: true,",
     "room.yaml:17: environment.obstacles[2].bears: expected a box, as only boxes bear"},
    {"BearsNoBoolean", "name: crate,", "name: crate, bears: 3,",
     "room.yaml:15: environment.obstacles[0].bears: expected true or false, got 3"},
    {"GroundMissing",
     "ground:\n    - {name: floor, size: [4, 6, 0.5], position: [2, 2, -0.25], yaw_deg: 90}",
     "ground: []",
     "room.yaml:12: environment.ground: expected at least one ground box, got an empty list"},
    {"ObstacleSizeNegative", "size: [1, 2, 3]", "size: [1, -0.2, 3]",
     "room.yaml:15: environment.obstacles[0].size: expected three positive numbers, got -0.2"},
    {"ObstacleSizeShort", "size: [1, 2, 3]", "size: [1, 2]",
     "room.yaml:15: environment.obstacles[0].size: expected three positive numbers, got a list of "
     "2"},
    {"ObstacleSizeText", "size: [1, 2, 3]", "size: [1, two, 3]",
     "room.yaml:15: environment.obstacles[0].size: expected three positive numbers, got two"},
    {"ObstaclePositionMissing", ", position: [1, 0, 0]", "",
     "room.yaml:15: environment.obstacles[0]: the key 'position' is missing"},
    {"ObstacleNameTaken", "name: bar", "name: crate",
     "room.yaml:16: environment.obstacles[1].name: this name is already taken"},
    {"ObstacleNameMissing", "name: bar, ", "",
     "room.yaml:16: environment.obstacles[1]: the key 'name' is missing"},
    {"ObstacleShapeMissing", "shape: sphere, ", "",
     "room.yaml:17: environment.obstacles[2]: the key 'shape' is missing"},
    {"ObstacleShapeUnknown", "shape: sphere", "shape: spere",
     "room.yaml:17: environment.obstacles[2].shape: expected box, sphere, cylinder, capsule or "
     "convex, got spere (did you mean 'sphere'?)"},
    {"CylinderWithoutLength", "length: 2, ", "",
     "room.yaml:16: environment.obstacles[1]: the key 'length' is missing"},
    {"SphereWithLength", "radius: 0.3, position: [0, 0, 1]}\n    - {name: pill",
     "radius: 0.3, length: 1, position: [0, 0, 1]}\n    - {name: pill",
     "room.yaml:17: environment.obstacles[2].length: a sphere has no length"},
    {"ConvexFlat", "[0, 0, 1]]", "[1, 1, 0]]",
     "room.yaml:19: environment.obstacles[4].vertices: expected at least four points that do not "
     "lie in one plane"},
    {"ConvexThreePoints", ", [0, 0, 1]]", "]",
     "room.yaml:19: environment.obstacles[4].vertices: expected at least four points that do not "
     "lie in one plane"},
    {"ConvexNaN", "[0, 0, 1]]", "[0, 0, nan]]",
     "room.yaml:19: environment.obstacles[4].vertices[3]: expected three numbers, got nan"},
};

INSTANTIATE_TEST_SUITE_P(Scenario, ScenarioErrors, ::testing::ValuesIn(kBad),
                         [](const auto& info) { return info.param.what; });

}  // namespace
}  // namespace possibility::models
