#pragma once

#include <Eigen/Core>
#include <functional>

#include "dynamics/rollout/joint_control.h"
#include "dynamics/tree/multibody_dynamics.h"

namespace possibility::dynamics {

/// Force on the root at its centre of mass over time (s), N, world. May be empty.
using RootPush = std::function<Eigen::Vector3d(double t)>;

/// Generalised forces on a robot beside gravity and contacts: its joints' torques and a push. One
/// workspace per thread. @throws what JointTorques throws.
class AppliedForces {
 public:
  AppliedForces(const MultibodyModel& model, JointControl control, RootPush push);

  /// At the state held by `dynamics`, nv. Otherwise as JointTorques::Evaluate.
  const Eigen::VectorXd& Evaluate(double t, const Eigen::Ref<const Eigen::VectorXd>& q,
                                  const Eigen::Ref<const Eigen::VectorXd>& v, bool is_supported,
                                  MultibodyDynamics* dynamics);

  const Eigen::VectorXd& generalised() const { return generalised_; }  ///< of the last Evaluate
  const JointTorques& torques() const { return torques_; }

 private:
  JointTorques torques_;
  RootPush push_;
  Eigen::VectorXd generalised_;
};

/// Derivatives of the joints' friction with respect to their rates; num_joints. `v`: nv.
Eigen::VectorXd FrictionSlopes(const MultibodyModel& model,
                               const Eigen::Ref<const Eigen::VectorXd>& v);

/// Adds the stiff part of a state's rate: velocities, and the accelerations that `to_position` and
/// `to_velocity` (nv x nv) give per change of the configuration's tangent and of the velocity.
/// `q`: nq. `jacobian`: (nq + nv) square.
void StateRateJacobian(const MultibodyModel& model, const Eigen::Ref<const Eigen::VectorXd>& q,
                       const Eigen::MatrixXd& to_position, const Eigen::MatrixXd& to_velocity,
                       Eigen::Ref<Eigen::MatrixXd> jacobian);

}  // namespace possibility::dynamics
