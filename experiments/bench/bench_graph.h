#pragma once

#include <filesystem>
#include <functional>

#include "experiments/bench/benchmark.h"
#include "models/robot/robot_model.h"

namespace possibility::experiments {

struct GraphBenchSettings {
  std::filesystem::path scenarios = "experiments/scenarios";
  int seeds = 20;
  int obstacles = 10000;          ///< of the field
  double time_limit = 10;         ///< s, of one search
  int preset_seeds = 3;           ///< 0: the presets are not compared
  double preset_time_limit = 60;  ///< s, of one plan
};

/// Times to the first solution of ways by one gait alone, for each of the robot's gaits, on
/// three_routes_a and a field of obstacles: the possibility graph beside OMPL's planners (left out
/// of programs that were built without it), all asking the same conditions of the same stances and
/// ways, in turn, seed by seed. A row's time is the median over seeds; a search without success
/// counts as the time limit, and who fails at the first three seeds is asked no more. Ratios:
/// first_solution_vs_ompl_<gait>, the best median of OMPL's planners over ours, the smaller of the
/// two scenes (absent without OMPL); default_vs_paper_preset (bench_presets.h).
/// @throws InputError if a scenario cannot be read.
BenchmarkReport BenchGraph(const models::RobotModel& robot, const GraphBenchSettings& settings,
                           const std::function<void(int, int)>& progress);

}  // namespace possibility::experiments
