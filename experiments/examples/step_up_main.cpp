// plan_step_up [SCENARIO.yaml [FOLDER]]: the tutorial's program (docs/tutorial_new_action.md).

#include <filesystem>
#include <iostream>

#include "actions/plan/plan_writer.h"
#include "actions/planner/planner.h"
#include "experiments/examples/step_up.h"
#include "models/input/input_error.h"
#include "models/robot/robot_yaml.h"

using namespace possibility;

int main(int argc, char** argv) {
  const std::string file =
      argc > 1 ? argv[1] : POSSIBILITY_SOURCE_DIR "/experiments/examples/plinth.yaml";
  const std::filesystem::path folder = argc > 2 ? argv[2] : "out/plinth";
  try {
    const models::Scenario scenario = models::LoadScenario(file);
    const models::RobotModel robot = models::LoadRobotModel(scenario.robot_file);
    actions::PlanRequest request;
    request.actions = {"walk", "step_up"};
    request.manoeuvres = {actions::StepUpFactory()};
    const actions::PlanResult result = actions::PlanTraversal(robot, scenario, request);
    std::cout << actions::ToString(result.status) << "\n" << result.explanation << "\n";
    if (result.status != actions::PlanStatus::kFound) return 2;
    std::filesystem::create_directories(folder);
    actions::WritePlan(result.plan, folder / "plan.json");
  } catch (const InputError& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
}
