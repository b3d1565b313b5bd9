#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <vector>

#include "dynamics/contact/bearing_points.h"
#include "dynamics/contact/contact_patches.h"
#include "dynamics/forward/forward_dynamics.h"
#include "dynamics/rollout/applied_forces.h"
#include "dynamics/rollout/joint_control.h"
#include "dynamics/rollout/robot_rollout.h"
#include "dynamics/rollout/rollout_stance.h"

namespace possibility::dynamics {

/// The robot of a rollout: its motion under joint control while some of its contacts are held.
/// States are (q, v), nq + nv. Keeps the state of the last SetState, Accelerate or MotionAt;
/// functions without a state argument use it. One workspace per thread.
/// @throws what ForwardDynamics and JointTorques throw.
class RolloutDynamics {
 public:
  RolloutDynamics(std::shared_ptr<const MultibodyModel> model, std::vector<RolloutContact> contacts,
                  JointControl control, const RobotRolloutSettings& settings);

  const MultibodyModel& model() const { return forward_.model(); }
  int nq() const { return model().nq(); }
  int nv() const { return model().nv(); }
  int num_contacts() const { return static_cast<int>(contacts_.size()); }
  const RolloutContact& contact(int index) const { return contacts_[index]; }
  /// A contact that represents a patch of held contacts.
  const RolloutContact& ContactOf(const ContactPatchBalance& patch,
                                  const std::vector<int>& held) const {
    return contacts_[held[patch.points.front()]];
  }
  bool Lands(int contact, const Eigen::VectorXd& state) const;
  void NormaliseOrientation(Eigen::VectorXd* state) const;

  void SetState(const Eigen::Ref<const Eigen::VectorXd>& state);
  double Gap(int contact);  ///< m above its plane
  /// The same at a state that need not be the current one, at a fraction of SetState's time.
  double GapAt(const Eigen::Ref<const Eigen::VectorXd>& state, int contact);
  double KineticEnergy(const Eigen::Ref<const Eigen::VectorXd>& v);
  std::vector<HeldPoint> HeldWhereTheyAre(const std::vector<int>& held);
  std::vector<ContactPatchBalance> PatchesOf(const std::vector<int>& held);
  const Impact& Hit(const std::vector<int>& contacts);

  /// Velocities of contacts, and their accelerations if none is held, as input of
  /// SelectBearingPoints. `state` must be the current state.
  UnilateralContacts UnilateralVelocities(const std::vector<int>& contacts);
  UnilateralContacts UnilateralAccelerations(double t,
                                             const Eigen::Ref<const Eigen::VectorXd>& state,
                                             const std::vector<int>& contacts);

  /// Acceleration at a state of a stance, nv. `forces`: 3 x held; may be null.
  Eigen::VectorXd Accelerate(double t, const Eigen::Ref<const Eigen::VectorXd>& state,
                             const RolloutStance& stance, Eigen::Matrix3Xd* forces);
  /// Whether the last Accelerate, of this stance at this time, was the last change of the state,
  /// and no position there is farther from that of `state` than `distance` (rad, m), and no
  /// velocity than `speed` (rad/s, m/s).
  bool IsNearLastAcceleration(double t, const Eigen::Ref<const Eigen::VectorXd>& state,
                              const RolloutStance& stance, double distance, double speed) const;
  /// Forces of the last Accelerate, 3 x held.
  const Eigen::Matrix3Xd& forces() const { return forces_; }
  double weight() const { return weight_; }  ///< N
  /// The stiff part of the derivative of the state's rate with respect to the state: velocities,
  /// joint feedback and the feedback of drift; without bias forces and gravity.
  void DifferentiateRate(double t, const Eigen::Ref<const Eigen::VectorXd>& state,
                         const RolloutStance& stance, Eigen::Ref<Eigen::MatrixXd> jacobian);
  RobotMotion MotionAt(double t, const Eigen::VectorXd& state, const RolloutStance& stance);
  /// Torques of the last Accelerate or MotionAt; num_joints.
  auto joint_torques() const { return applied_.generalised().tail(model().num_joints()); }
  /// Acceleration of a held contact along its normal while all others are held, under
  /// joint_torques().
  double AccelerationIfLetGo(const RolloutStance& stance, int contact);

 private:
  MultibodyDynamics* dynamics() { return forward_.dynamics(); }
  /// At the current state, nv.
  const Eigen::VectorXd& Applied(double t, const Eigen::Ref<const Eigen::VectorXd>& state,
                                 bool has_landed);
  UnilateralContacts Unilateral(const std::vector<int>& contacts, Eigen::VectorXd unconstrained);

  ForwardDynamics forward_;
  AppliedForces applied_;
  std::vector<RolloutContact> contacts_;
  TreeKinematics kinematics_;  // of GapAt
  Eigen::VectorXd position_;   // of kinematics_, nq
  double weight_;
  const RolloutStance* accelerated_ = nullptr;  // of the last Accelerate, if at the current state
  double time_ = 0;                             // of the last Accelerate; so are these
  Eigen::VectorXd state_;
  Eigen::Matrix3Xd forces_;
};

}  // namespace possibility::dynamics
