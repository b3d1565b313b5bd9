#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "models/robot/robot_model.h"

namespace possibility::experiments {

/// Solves the walking step (walking_step.h) of all joints on 15 intervals from its guess, disturbed
/// by noise of 0.1 rad at every joint and node. Figures: "converged", "of", "median_s" (processor
/// time of a solve), "kkt_ms" (linear algebra of an iteration), "kkt_speedup" (processor time of
/// whole solves with MUMPS over ours, median of pairs).
std::vector<std::pair<std::string, double>> BenchSpatialStep(
    const models::RobotModel& robot, int guesses, const std::function<void(int, int)>& progress);

}  // namespace possibility::experiments
