#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "dynamics/tree/multibody_dynamics.h"

namespace possibility::dynamics {

/// What the joints are asked for at one time; num_joints each.
struct JointCommand {
  Eigen::VectorXd position;  ///< rad or m
  Eigen::VectorXd velocity;
  Eigen::VectorXd torque;  ///< feed-forward, N m or N
};

/// Joint torques: feed-forward + stiffness (position - q) + damping (velocity - v), gravity
/// compensation if wanted, clamped to the model's effort limits.
struct JointControl {
  /// Fills a command that comes in with zeros; none: zeros.
  std::function<void(double t, JointCommand* command)> command;
  Eigen::VectorXd stiffness;  ///< num_joints, N m/rad or N/m; empty: none
  Eigen::VectorXd damping;    ///< num_joints, N m s/rad or N s/m; empty: none
  /// Adds the torques that would keep the joints from accelerating at rest if the points of
  /// `gravity_support` were held: those of a static stance where they can carry the robot. From the
  /// first contact of a rollout on they do not ask which points are held: torques that jumped with
  /// every contact could make a contact that bears exactly when it does not.
  bool compensates_gravity = false;
  std::vector<ContactPoint> gravity_support;
};

/// Evaluates a JointControl for one model. One workspace per thread.
class JointTorques {
 public:
  /// @throws std::invalid_argument if gains have a wrong size, are negative or not finite, or a
  /// point of the support names no link.
  JointTorques(const MultibodyModel& model, JointControl control);

  /// At the state held by `dynamics` (q and v are that state); num_joints. Gravity is compensated
  /// only if `is_supported`.
  /// @throws std::invalid_argument if the command has a wrong size or is not finite.
  const Eigen::VectorXd& Evaluate(double t, const Eigen::Ref<const Eigen::VectorXd>& q,
                                  const Eigen::Ref<const Eigen::VectorXd>& v, bool is_supported,
                                  MultibodyDynamics* dynamics);

 private:
  void AddGravityCompensation(MultibodyDynamics* dynamics);

  JointControl control_;
  Eigen::VectorXd limits_;
  JointCommand command_;
  Eigen::VectorXd torques_;
};

}  // namespace possibility::dynamics
