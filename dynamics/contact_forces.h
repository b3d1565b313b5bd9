#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "dynamics/tree_kinematics.h"

namespace possibility::dynamics {

/// A point of the robot that bears on flat ground (normal +z).
struct ContactPoint {
  int link = 0;
  Eigen::Vector3d p_L = Eigen::Vector3d::Zero();
};

struct ContactForceSettings {
  double friction = 0.7;         ///< Coulomb; the cone is linearised from inside with 8 edges
  double friction_margin = 0.9;  ///< fraction of `friction` that may be used
  double torque_margin = 0.95;   ///< fraction of each joint's effort limit that may be used
  /// N: every point's cone starts at this normal force, so that a force that turns out smaller by
  /// less than it still lies in the cone.
  double normal_reserve = 0;
};

struct ContactForces {
  Eigen::Matrix3Xd forces;  ///< 3 x points, on the robot, world axes, N
  Eigen::VectorXd torques;  ///< num_joints
  /// Greatest tangential force over friction * normal force (without the margin); 0 at points
  /// that bear nothing.
  double friction_utilisation = 0;
  /// Greatest |torque| over effort limit (without the margin).
  double torque_utilisation = 0;
};

/// Forces in the friction cones and joint torques within limits that realise acceleration `a` at
/// the state held by `kinematics` (SetPosition and SetVelocity done): the smallest forces and
/// torques in a weighted square norm, so a smooth function of the state while the active set
/// stays. None if no such forces exist. Without points: the torques of free flight, if `a` is
/// one that a flying robot can have.
/// @throws std::invalid_argument if `a` has a wrong size or is not finite, a point names no link,
/// or a setting is negative or not finite.
std::optional<ContactForces> DistributeContactForces(TreeKinematics* kinematics,
                                                     const Eigen::Ref<const Eigen::VectorXd>& a,
                                                     const std::vector<ContactPoint>& points,
                                                     const ContactForceSettings& settings);

}  // namespace possibility::dynamics
