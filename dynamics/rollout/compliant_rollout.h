#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <vector>

#include "dynamics/contact/compliant_ground.h"
#include "dynamics/forward/forward_dynamics.h"
#include "dynamics/ode/ode_integrator.h"
#include "dynamics/rollout/applied_forces.h"
#include "dynamics/rollout/robot_rollout.h"

namespace possibility::dynamics {

struct CompliantRolloutSettings {
  CompliantRolloutSettings();

  CompliantGround ground;
  OdeSettings integration;  ///< default: BDF, relative tolerance 1e-6, steps of 0.01 s at most
  RootPush push;            ///< as RobotRolloutSettings::push
  /// The rollout ends where this falls below 0. `q`: nq. May be empty.
  std::function<double(double t, const Eigen::Ref<const Eigen::VectorXd>& q)> until;
};

struct CompliantRollout {
  OdeEnd end = OdeEnd::kTime;
  OdeTrajectory trajectory;  ///< of (q, v)
  OdeStatistics statistics;
  int nq = 0;

  Eigen::VectorXd Configuration(double t) const;  ///< nq, quaternion normalised
  Eigen::VectorXd Velocity(double t) const;       ///< nv
};

/// Simulates a robot under joint control over planes of compliant ground, on which points may
/// slide. Unlike RobotSimulator it has no events: contacts are forces. Deeper than `kSide` a point
/// is beside a plane, not in it. Joint stops and other collisions are not simulated. One simulator
/// per thread.
class CompliantSimulator {
 public:
  static constexpr double kSide = 0.02;  ///< m

  /// @throws std::invalid_argument for invalid gains.
  CompliantSimulator(std::shared_ptr<const MultibodyModel> model,
                     std::vector<RolloutContact> contacts, JointControl control,
                     CompliantRolloutSettings settings = {});

  /// @throws std::invalid_argument for a state of wrong size; OdeError if the integrator gives up.
  CompliantRollout Run(const Eigen::Ref<const Eigen::VectorXd>& q,
                       const Eigen::Ref<const Eigen::VectorXd>& v, double start_time,
                       double end_time);

  /// Motion at a time of a rollout.
  RobotMotion MotionAt(const CompliantRollout& rollout, double t);

 private:
  const MultibodyModel& model() const { return forward_.model(); }
  /// Sets the state, and forces_ and generalised_ with it.
  void SetForces(double t, const Eigen::Ref<const Eigen::VectorXd>& state);
  double Gap(const RolloutContact& contact);  ///< m above its plane
  bool Bears(const RolloutContact& contact, const Eigen::Ref<const Eigen::VectorXd>& q,
             double gap) const;
  Eigen::VectorXd Accelerate(double t, const Eigen::Ref<const Eigen::VectorXd>& state);
  void DifferentiateRate(double t, const Eigen::Ref<const Eigen::VectorXd>& state,
                         Eigen::Ref<Eigen::MatrixXd> jacobian);

  CompliantRolloutSettings settings_;
  ForwardDynamics forward_;
  AppliedForces applied_;
  std::vector<RolloutContact> contacts_;
  Eigen::Matrix3Xd forces_;      ///< of the ground, by contact
  Eigen::VectorXd generalised_;  ///< nv
};

}  // namespace possibility::dynamics
