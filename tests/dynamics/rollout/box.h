#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "models/robot/robot_model.h"
#include "tests/dynamics/rollout/walking_models.h"

namespace possibility::dynamics {

/// A box of 1 kg, 0.4 x 0.2 x 0.2 m, with contacts at its four lower corners; planar or in space.
inline models::RobotModel Box() {
  models::RobotModel robot;
  robot.name = "box";
  robot.links = {LinkOf("box", 1, Eigen::Vector3d::Zero(), 0)};
  robot.links[0].inertial.I_LC.diagonal() << 0.08 / 12, 0.2 / 12, 0.2 / 12;
  return robot;
}

inline std::vector<RolloutContact> Corners(const Eigen::Vector3d& normal) {
  std::vector<RolloutContact> contacts;
  for (const double x : {-0.2, 0.2}) {
    for (const double y : {-0.1, 0.1}) {
      contacts.push_back(ContactOn("corner", 0, {x, y, -0.1}, normal));
    }
  }
  return contacts;
}

inline Eigen::VectorXd BoxAt(double height, double roll = 0, double pitch = 0) {
  Eigen::VectorXd q = Eigen::VectorXd::Zero(7);
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
                                Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()));
  q << turn.w(), turn.x(), turn.y(), turn.z(), 0, 0, height;
  return q;
}

}  // namespace possibility::dynamics
