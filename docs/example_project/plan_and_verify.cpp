// plan_and_verify SCENARIO.yaml FOLDER: plans, verifies what was written, and says what was found.

#include <filesystem>
#include <iostream>

#include "actions/plan/plan_reader.h"
#include "actions/plan/plan_writer.h"
#include "actions/planner/planner.h"
#include "actions/verify/verifier.h"
#include "models/input/input_error.h"
#include "models/robot/robot_yaml.h"
#include "models/world/scenario.h"

using namespace possibility;

int main(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "usage: plan_and_verify SCENARIO.yaml FOLDER\n";
    return 1;
  }
  try {
    const models::Scenario scenario = models::LoadScenario(argv[1]);
    const models::RobotModel robot = models::LoadRobotModel(scenario.robot_file);

    actions::PlanRequest request;
    request.seed = 7;
    request.time_limit = 60;  // s
    const actions::PlanResult result = actions::PlanTraversal(robot, scenario, request);
    if (result.status != actions::PlanStatus::kFound) {
      std::cerr << actions::ToString(result.status) << ": " << result.explanation << "\n";
      return 2;
    }

    const std::filesystem::path file = std::filesystem::path(argv[2]) / "plan.json";
    std::filesystem::create_directories(file.parent_path());
    actions::WritePlan(result.plan, file);

    const actions::Plan read = actions::ReadPlan(file);
    const bool accepted = actions::Verify(read, robot, scenario).accepted();
    std::cout << robot.name << ", " << read.segments.size() << " segments, " << read.duration()
              << " s, " << (accepted ? "verified" : "refused") << "\n";
    return accepted ? 0 : 3;
  } catch (const InputError& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
}
