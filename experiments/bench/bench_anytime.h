#pragma once

#include <filesystem>
#include <functional>

#include "experiments/bench/benchmark.h"
#include "models/robot/robot_model.h"

namespace possibility::experiments {

struct AnytimeBenchSettings {
  std::filesystem::path scenarios = "experiments/scenarios";
  double time_limit = 30;      ///< s, of each plan
  std::filesystem::path plot;  ///< SVG; empty: none
};

/// Plans every scenario of the folder that has a plan until the time limit, and goes on looking for
/// quicker plans (PlanRequest::improved). Every plan is verified once more, from nothing. Rows: a
/// scenario each, with the first and the last duration and the lower bound. Reports scenarios
/// through `progress` (done, of).
/// @throws InputError if the folder holds no scenario of this robot, or the plot cannot be written.
BenchmarkReport BenchAnytime(const models::RobotModel& robot, const AnytimeBenchSettings& settings,
                             const std::function<void(int, int)>& progress);

}  // namespace possibility::experiments
