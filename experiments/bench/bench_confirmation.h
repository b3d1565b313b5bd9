#pragma once

#include <functional>

#include "experiments/bench/benchmark.h"
#include "models/robot/robot_model.h"

namespace possibility::experiments {

/// Confirms the robot's jumps over a grid of distances and heights, cold and from a library.
/// Ratios: confirmed_fraction (of the jumps between the shortest and the farthest found of each
/// height), two_worker_throughput (jumps per second of two workers over one). Figures:
/// cold_s_median, library_s_median and the breakdown of the cold jumps' time.
BenchmarkReport BenchConfirmation(const models::RobotModel& robot,
                                  const std::function<void(int, int)>& progress);

}  // namespace possibility::experiments
