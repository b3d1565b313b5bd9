#pragma once

#include <optional>
#include <string>
#include <vector>

#include "actions/plan/plan.h"
#include "models/robot/robot_model.h"

namespace possibility::actions {

/// Parsed entry of Phase::contacts: "left_sole" or "left_sole[0,3]".
struct ContactName {
  std::string patch;
  std::optional<std::vector<int>> points;  ///< ascending; none: all points of the patch
};

/// A name that ends in ']' lists points.
/// @throws InputError saying what is wrong and what was expected; the caller adds the place.
ContactName ParseContactName(const std::string& text);

/// "left_sole[0,3]". Inverse of ParseContactName if `points` ascend.
std::string FormatContactName(const std::string& patch, const std::vector<int>& points);

/// A bearing patch or part of a patch.
struct BearingPatch {
  int patch = 0;            ///< index into RobotModel::contacts
  std::vector<int> points;  ///< ascending indices into its points
};

/// The contacts of a phase as patches, in the same order.
/// @throws InputError naming a contact that is malformed, not the robot's, or of a patch that an
/// earlier contact names.
std::vector<BearingPatch> BearingPatches(const models::RobotModel& robot, const Phase& phase);

/// The bearing points as a patch of their own.
models::ContactPatch PatchOf(const models::RobotModel& robot, const BearingPatch& bearing);

/// The number of columns of Knot::forces. @throws InputError likewise.
Eigen::Index CountPoints(const models::RobotModel& robot, const Phase& phase);

}  // namespace possibility::actions
