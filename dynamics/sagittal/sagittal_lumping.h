#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "dynamics/tree/contact_point.h"
#include "models/robot/robot_model.h"

namespace possibility::dynamics {

/// The joints of a full robot that one joint stands for: at a symmetric state the right one's
/// position is right_sign times the left one's.
struct SagittalJoint {
  int left = -1;
  int right = -1;  ///< -1: a joint of the middle
  double right_sign = 1;
};

/// A robot folded onto its plane y = 0 (SagittalReduction says how), and where everything went.
struct SagittalLumping {
  models::RobotModel tree;
  std::vector<SagittalJoint> joints;    ///< by joint of the tree
  std::vector<SagittalJoint> locked;    ///< pairs that are not joints of the tree
  std::vector<int> lumped_link;         ///< by full link: link of the tree
  std::vector<Eigen::Isometry3d> X_GL;  ///< by full link: its pose in that link
  Eigen::VectorXd rest;                 ///< full joints where those of the tree are 0
  std::vector<std::vector<std::vector<ContactPoint>>> full_points;  ///< by contact and point
};

/// `locked`: num_joints, finite.
/// @throws InputError naming the joints or contacts that do not fold.
SagittalLumping LumpSagittally(const models::RobotModel& robot, const Eigen::VectorXd& locked);

}  // namespace possibility::dynamics
