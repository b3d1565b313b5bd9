#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>

#include "models/robot/robot_model.h"

namespace possibility::actions {

/// The knee or elbow of a limb: the joint between its two longest parts.
struct LimbBend {
  std::string name;
  std::size_t joint = 0;  ///< index into GaitLimb::joints
  int before = -1;        ///< link that begins at the last joint before it that swings the upper
                          ///< part and does not only twist it; its origin is that joint
  int after = -1;         ///< link that begins at the joint after it; the bend's own if there is none
  /// Where the lower part ends, in that link: its origin, or the centre of the limb's contact.
  Eigen::Vector3d end = Eigen::Vector3d::Zero();
  double length = 0;  ///< m, from one to the other if stretched
};

/// None if the limb has no joint between two parts. A limb that ends in a contact without joints of
/// its own, such as a peg or a point foot, may bend in its last joint.
std::optional<LimbBend> BendOf(const models::RobotModel& robot, const models::GaitLimb& limb);

}  // namespace possibility::actions
