#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "dynamics/tree/multibody_dynamics.h"

namespace possibility::dynamics {

/// The joint commands at one time; num_joints each.
struct JointCommand {
  Eigen::VectorXd position;  ///< rad or m
  Eigen::VectorXd velocity;
  Eigen::VectorXd torque;  ///< feed-forward, N m or N
};

/// Joint torques: feed-forward + stiffness (position - q) + damping (velocity - v), plus gravity
/// compensation if enabled, clamped to what the actuators can deliver at the joints' speeds.
struct JointControl {
  /// Fills in a command that is initialised with zeros. If empty, the command stays zero.
  std::function<void(double t, JointCommand* command)> command;
  Eigen::VectorXd stiffness;  ///< num_joints, N m/rad or N/m; empty: none
  Eigen::VectorXd damping;    ///< num_joints, N m s/rad or N s/m; empty: none
  /// Adds the torques that would keep the joints from accelerating at rest if the points of
  /// `gravity_support` were held: those of a static stance if these points can carry the robot.
  /// From the first contact of a rollout on, the torques do not depend on which points are held. If
  /// they jumped with every contact, a contact could bear exactly when it is taken not to bear.
  bool compensates_gravity = false;
  std::vector<ContactPoint> gravity_support;
};

/// Evaluates a JointControl for one model. One workspace per thread.
class JointTorques {
 public:
  /// @throws std::invalid_argument if gains have a wrong size, are negative or not finite, or a
  /// point of the support names no link.
  JointTorques(const MultibodyModel& model, JointControl control);

  /// Torques at the state held by `dynamics` (q and v are that state); num_joints. Gravity is
  /// compensated only if `is_supported`.
  /// @throws std::invalid_argument if the command has a wrong size or is not finite.
  const Eigen::VectorXd& Evaluate(double t, const Eigen::Ref<const Eigen::VectorXd>& q,
                                  const Eigen::Ref<const Eigen::VectorXd>& v, bool is_supported,
                                  MultibodyDynamics* dynamics);

  /// Gains of the last Evaluate: those of the control, zero where the torque is at its limit.
  Eigen::VectorXd Stiffness() const { return Active(control_.stiffness); }
  Eigen::VectorXd Damping() const { return Active(control_.damping); }

 private:
  void Clamp(const Eigen::Ref<const Eigen::VectorXd>& v, const MultibodyModel& model);
  Eigen::VectorXd Active(const Eigen::VectorXd& gains) const;
  void AddGravityCompensation(MultibodyDynamics* dynamics);

  JointControl control_;
  Eigen::VectorXd lower_, upper_;  // limits at the last state
  JointCommand command_;
  Eigen::VectorXd torques_;
};

}  // namespace possibility::dynamics
