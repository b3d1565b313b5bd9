// plan_optimised_walk [SCENARIO.yaml [FOLDER]]: from the scenario's start straight ahead to its
// goal, by optimal control (docs/collocation.md, "A walk").

#include <filesystem>
#include <iostream>

#include "actions/plan/plan_writer.h"
#include "actions/wholebody/motion_error.h"
#include "actions/wholebody/whole_body_task.h"
#include "experiments/examples/optimised_walk.h"
#include "models/input/input_error.h"
#include "models/robot/robot_yaml.h"

using namespace possibility;

int main(int argc, char** argv) {
  const std::string file =
      argc > 1 ? argv[1] : POSSIBILITY_SOURCE_DIR "/experiments/examples/long_floor.yaml";
  const std::filesystem::path folder = argc > 2 ? argv[2] : "out/optimised_walk";
  try {
    const models::Scenario scenario = models::LoadScenario(file);
    const models::RobotModel robot = models::LoadRobotModel(scenario.robot_file);
    const double distance = actions::DistanceAhead(scenario);
    const actions::Plan plan = actions::OptimisedWalk(robot, scenario, distance);
    std::filesystem::create_directories(folder);
    actions::WritePlan(plan, folder / "plan.json");
    std::cout << "walks " << distance << " m in " << plan.duration() << " s\n";
  } catch (const InputError& error) {
    std::cerr << error.what() << "\n";
    return 1;
  } catch (const actions::MotionError& error) {
    std::cerr << "no walk: " << error.what() << "\n";
    return 2;
  }
}
