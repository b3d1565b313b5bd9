#include "experiments/bench/scenario_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#include <utility>

#include "models/input/input_error.h"

namespace possibility::experiments {

std::vector<models::Scenario> ScenariosOf(const models::RobotModel& robot,
                                          const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  std::error_code ignored;  // a folder that cannot be read holds no scenarios
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
    if (entry.path().extension() == ".yaml") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  std::vector<models::Scenario> scenarios;
  for (const std::filesystem::path& file : files) {
    models::Scenario scenario = models::LoadScenario(file);
    if (scenario.robot_hash == robot.content_hash) scenarios.push_back(std::move(scenario));
  }
  if (scenarios.empty()) {
    throw InputError(fmt::format("--scenarios: {} holds no scenario of {}, expected some",
                                 folder.string(), robot.file.string()));
  }
  return scenarios;
}

}  // namespace possibility::experiments
