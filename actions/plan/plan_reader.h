#pragma once

#include "actions/plan/plan.h"

namespace possibility::actions {

/// The plan file that a path means: of a folder its plan.json, or if there is none its plan.zip.
std::filesystem::path PlanFileOf(const std::filesystem::path& file_or_directory);

/// Reads a plan file of either version, told apart by its contents, or that of a folder. Resolves
/// paths inside against the plan's folder. tau is empty in all knots of a file of version 2 without
/// torques: CompleteTorques (actions/checks/plan_torques.h) computes them, which needs the robot.
/// @throws InputError naming the file, the key, and what was expected (truncated files, another
/// format version, wrong sizes, numbers that are not finite, times out of order within a phase).
Plan ReadPlan(const std::filesystem::path& file_or_directory);

}  // namespace possibility::actions
