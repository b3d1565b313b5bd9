#pragma once

#include <filesystem>

#include "actions/plan/plan.h"
#include "models/robot/robot_model.h"
#include "models/world/scenario.h"

namespace possibility::experiments {

/// A plan with the robot and scenario that it names.
struct LoadedPlan {
  std::filesystem::path file;  ///< the plan file itself
  actions::Plan plan;
  models::Scenario scenario;
  models::RobotModel robot;

  /// Whether robot and scenario are byte for byte the ones planned for.
  bool IsCurrent() const;
};

/// Reads a plan file of either version or that of a folder, then the robot and scenario it names.
/// @throws InputError for anything malformed or missing.
LoadedPlan LoadPlan(const std::filesystem::path& file_or_directory);

/// Replacements for the files named in the plan and scenario; empty: as named.
struct VerifiedWith {
  std::filesystem::path robot;
  std::filesystem::path scenario;
};

/// LoadPlan for verification: takes the robot that the scenario names, not the plan's.
/// @throws InputError likewise.
LoadedPlan LoadPlanToVerify(const std::filesystem::path& file_or_directory,
                            const VerifiedWith& files);

/// Requires that the sizes of every knot and the contacts of every phase fit the robot, which the
/// plan's reader does not know.
/// @throws InputError naming the file and the segment.
void RequireFit(const LoadedPlan& loaded);

/// Requires a plan with motion: a "no" has nothing to verify or export.
/// @throws InputError naming the file and the answer.
void RequireMotion(const LoadedPlan& loaded);

}  // namespace possibility::experiments
