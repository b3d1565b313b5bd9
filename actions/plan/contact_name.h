#pragma once

#include <optional>
#include <string>
#include <vector>

#include "actions/plan/plan.h"
#include "models/robot/robot_model.h"

namespace possibility::actions {

/// What an entry of Phase::contacts says: "left_sole" or "left_sole[0,3]".
struct ContactName {
  std::string patch;
  std::optional<std::vector<int>> points;  ///< ascending; none: all that the patch has
};

/// A name that ends in ']' lists points.
/// @throws InputError saying what is wrong and what was expected (the caller knows where).
ContactName ParseContactName(const std::string& text);

/// "left_sole[0,3]". ParseContactName's inverse if `points` ascend.
std::string FormatContactName(const std::string& patch, const std::vector<int>& points);

/// A patch, or part of it, that bears.
struct BearingPatch {
  int patch = 0;            ///< index into RobotModel::contacts
  std::vector<int> points;  ///< ascending indices into its points
};

/// The same for the contacts of a phase, in their order.
/// @throws InputError naming a contact that is malformed, not the robot's, or of a patch that an
/// earlier one names already.
std::vector<BearingPatch> BearingPatches(const models::RobotModel& robot, const Phase& phase);

/// The number of columns of Knot::forces. @throws InputError likewise.
Eigen::Index CountPoints(const models::RobotModel& robot, const Phase& phase);

}  // namespace possibility::actions
