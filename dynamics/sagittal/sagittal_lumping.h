#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "dynamics/tree/contact_point.h"
#include "models/robot/robot_model.h"

namespace possibility::dynamics {

/// The joints of a full robot that one joint represents. In a symmetric state the right joint's
/// position is right_sign times the left one's.
struct SagittalJoint {
  int left = -1;
  int right = -1;  ///< -1: a joint in the middle
  double right_sign = 1;
};

/// A robot folded onto its plane y = 0 (see SagittalReduction), with the map from full to lumped
/// parts.
struct SagittalLumping {
  models::RobotModel tree;
  std::vector<SagittalJoint> joints;    ///< by joint of the tree
  std::vector<SagittalJoint> locked;    ///< pairs that are not joints of the tree
  std::vector<int> lumped_link;         ///< by full link: link of the tree
  std::vector<Eigen::Isometry3d> X_GL;  ///< by full link: its pose in that link
  Eigen::VectorXd rest;                 ///< full joint positions when the tree's joints are at 0
  std::vector<std::vector<std::vector<ContactPoint>>> full_points;  ///< by contact and point
};

/// `locked`: num_joints, finite.
/// @throws InputError naming the joints or contacts that do not fold.
SagittalLumping LumpSagittally(const models::RobotModel& robot, const Eigen::VectorXd& locked);

}  // namespace possibility::dynamics
