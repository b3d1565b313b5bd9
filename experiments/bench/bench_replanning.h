#pragma once

#include <filesystem>
#include <functional>

#include "experiments/bench/benchmark.h"
#include "models/robot/robot_model.h"

namespace possibility::experiments {

struct ReplanningBenchSettings {
  std::filesystem::path scenarios = "experiments/scenarios";
  int moves = 50;
};

/// In the scenarios of the folder, in turn, moves one obstacle that is no ground by at most 0.5 m
/// (a crate, where there is none), and plans the moved scene twice: from nothing, and by the
/// Replanner that has planned the scene as it is. Every plan is verified from nothing. Rows: a
/// moved scene each. Scenes without a plan before the move are left out. Reports moved scenes
/// through `progress` (done, of).
/// @throws InputError if the folder holds no scenario of this robot.
BenchmarkReport BenchReplanning(const models::RobotModel& robot,
                                const ReplanningBenchSettings& settings,
                                const std::function<void(int, int)>& progress);

}  // namespace possibility::experiments
