#pragma once

#include <functional>

#include "experiments/bench/benchmark.h"
#include "models/robot/robot_model.h"

namespace possibility::experiments {

/// Times dynamics/ on random states of `robot`, against Simbody and, where this program was built
/// with it, DART. Ratios: derivatives_speedup (central differences through Simbody over our first
/// derivatives of inverse dynamics), inverse_dynamics_vs_dart (absent without DART),
/// two_thread_throughput.
BenchmarkReport BenchDynamics(const models::RobotModel& robot,
                              const std::function<void(int, int)>& progress);

}  // namespace possibility::experiments
