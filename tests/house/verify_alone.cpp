// Linked with the verifier's room alone, to show that it needs nothing else.
#include <cstdio>

#include "actions/plan/plan_reader.h"
#include "actions/verify/verifier.h"
#include "models/input/input_error.h"
#include "models/robot/robot_yaml.h"
#include "models/world/scenario.h"

// verify_alone PLAN ROBOT.yaml SCENARIO.yaml: exit code 0 if the plan is accepted.
int main(int argc, char** argv) {
  using namespace possibility;
  if (argc != 4) return 1;
  try {
    const models::RobotModel robot = models::LoadRobotModel(argv[2]);
    const models::Scenario scenario = models::LoadScenario(argv[3]);
    return actions::Verify(actions::ReadPlan(argv[1]), robot, scenario).accepted() ? 0 : 3;
  } catch (const InputError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
