#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "dynamics/tree/contact_point.h"
#include "dynamics/tree/multibody_dynamics.h"

namespace possibility::dynamics {

struct ContactForceSettings {
  /// Coulomb; the lesser of this and the point's own counts. The cone is linearised from inside.
  double friction = 0.7;
  double friction_margin = 0.9;  ///< fraction of the friction that may be used
  double torque_margin = 0.95;   ///< fraction of each joint's torque limit that may be used
  /// N: every point's cone starts at this normal force, so that a force that turns out smaller by
  /// less than this still lies in the cone.
  double normal_reserve = 0;
  /// Edges of the pyramid inside the cone, at least 3. With n edges it reaches cos(pi / n) of the
  /// friction in every direction.
  int cone_edges = 8;
  /// By point, in (0, 1]: a point with a smaller share bears less wherever the balance allows. Its
  /// squared force counts 1 / share^2 times, and its reserve is multiplied by the share. Empty: all
  /// are 1.
  std::vector<double> shares;
};

struct ContactForces {
  Eigen::Matrix3Xd forces;  ///< 3 x points, on the robot, world axes, N
  Eigen::VectorXd torques;  ///< by (independent) joint
  /// Greatest ratio of tangential force to friction * normal force (without the margin); 0 at
  /// points that bear nothing.
  double friction_utilisation = 0;
  /// Greatest |torque| over torque limit (without the margin).
  double torque_utilisation = 0;
};

/// Forces in the friction cones and joint torques within limits that realise the acceleration at
/// the state of `dynamics`. They are the smallest in a weighted square norm, hence a smooth
/// function of the state while the active set stays the same. Torques and limits
/// (MultibodyDynamics::torque_limits) are those of MultibodyModel's independent joints. None if no
/// such forces exist. Without points: the torques of free flight, if a flying robot can have that
/// acceleration.
/// @throws std::invalid_argument if the forces are not finite, a point names no link or is not
/// finite, a normal is not a unit vector, a friction is not positive, a setting is out of range, or
/// there is not one share per point.
std::optional<ContactForces> DistributeContactForces(MultibodyDynamics* dynamics,
                                                     const std::vector<ContactPoint>& points,
                                                     const ContactForceSettings& settings);

/// Tangential over normal force; 0 if there is no force along the normal.
double FrictionUsed(const ContactPoint& point, const Eigen::Vector3d& force);

}  // namespace possibility::dynamics
