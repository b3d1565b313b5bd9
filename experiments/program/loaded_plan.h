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

  /// Whether robot and scenario are still, byte for byte, the ones planned for.
  bool IsCurrent() const;
};

/// Reads DIR/plan.json or a plan file, then the robot and scenario it names.
/// @throws InputError for anything malformed or missing.
LoadedPlan LoadPlan(const std::filesystem::path& file_or_directory);

/// The files to verify a plan with, where they are not those that files name; empty: as named.
struct VerifiedWith {
  std::filesystem::path robot;
  std::filesystem::path scenario;
};

/// The same for verification: the robot is the one that the scenario names, whatever the plan says.
/// @throws InputError likewise.
LoadedPlan LoadPlanToVerify(const std::filesystem::path& file_or_directory,
                            const VerifiedWith& files);

/// Makes sure that the sizes of every knot and the contacts of every phase are the robot's, which
/// the plan's reader cannot know.
/// @throws InputError naming the file and the segment.
void RequireFit(const LoadedPlan& loaded);

/// Makes sure that the plan is no "no", which has no motion to verify or export.
/// @throws InputError naming the file and the answer.
void RequireMotion(const LoadedPlan& loaded);

}  // namespace possibility::experiments
