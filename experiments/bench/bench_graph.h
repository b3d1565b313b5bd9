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
  int preset_seeds = 3;           ///< 0: presets are not compared
  double preset_time_limit = 60;  ///< s, of one plan
};

/// Measures the time to the first solution for ways in one gait, for each of the robot's gaits, on
/// three_routes_a and a field of obstacles. Compares the possibility graph with OMPL's planners
/// (absent if built without OMPL). All planners use the same conditions for stances and ways and
/// run in turn, seed by seed. A row's time is the median over seeds; a failed search counts as the
/// time limit, and a planner that fails at the first three seeds is dropped. Ratios:
/// first_solution_vs_ompl_<gait>, the best median of OMPL's planners over ours, the smaller of the
/// two scenes (absent without OMPL); default_vs_paper_preset (bench_presets.h).
/// @throws InputError if a scenario cannot be read.
BenchmarkReport BenchGraph(const models::RobotModel& robot, const GraphBenchSettings& settings,
                           const std::function<void(int, int)>& progress);

}  // namespace possibility::experiments
