#pragma once

#include <filesystem>
#include <functional>

#include "experiments/bench/benchmark.h"
#include "models/robot/robot_model.h"

namespace possibility::experiments {

/// Number of plans that ComparePresets makes.
int NumPresetPlans(int seeds);

/// Plans the paper's scenarios with three actions by both presets in turn, seed by seed, on one
/// thread and with the robot's own library. Adds a row per scenario and preset (time in the graph,
/// confirmation included; the time limit where no plan was found) and the ratio
/// default_vs_paper_preset: the median over scenarios of the paper preset's median over the
/// default's. `on_plan`: called after every plan.
/// @throws InputError if a scenario cannot be read.
void ComparePresets(const models::RobotModel& robot, const std::filesystem::path& scenarios,
                    int seeds, double time_limit, const std::function<void()>& on_plan,
                    BenchmarkReport* report);

}  // namespace possibility::experiments
