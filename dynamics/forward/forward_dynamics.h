#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "dynamics/forward/branched_cholesky.h"
#include "dynamics/forward/gram_solver.h"
#include "dynamics/forward/rigid_basis.h"
#include "dynamics/tree/multibody_dynamics.h"

namespace possibility::dynamics {

/// A point of the robot held where it is: it neither slides nor leaves the ground.
struct HeldPoint {
  ContactPoint point;
  /// Position at which it is held, world, m. Drift from there is fed back
  /// (ForwardDynamicsSettings).
  Eigen::Vector3d anchor = Eigen::Vector3d::Zero();
};

struct ForwardDynamicsSettings {
  /// s: drift of a held point decays like a critically damped oscillator of this time constant
  /// (Baumgarte 1972). Infinite: no feedback, anchors are ignored.
  double drift_time = 0.02;
};

/// The motion of a robot under given forces while points of it are held.
struct ConstrainedMotion {
  Eigen::VectorXd acceleration;  ///< nv
  /// 3 x points, on the robot, world axes, N. The forces of least square norm if a rigid body does
  /// not determine how points share a load.
  Eigen::Matrix3Xd forces;
};

/// Derivatives of the acceleration of a robot with held points, with relative errors of about 1e-7.
struct ConstrainedResponse {
  Eigen::MatrixXd to_forces;  ///< nv x nv: acceleration per generalised force
  /// nv x nv, D: where the held points have moved from their anchors by dq and move at dv (both
  /// nv), feedback at rate r (1/s) adds -D (2 r dv + r^2 dq) to the acceleration.
  Eigen::MatrixXd to_drift;
};

/// An inelastic impact: the velocity after it and its impulses.
struct Impact {
  Eigen::VectorXd velocity;   ///< nv, after
  Eigen::Matrix3Xd impulses;  ///< 3 x points, on the robot, world axes, N s, least square norm
  double energy_lost = 0;     ///< J, >= 0
};

/// Forward dynamics of a MultibodyModel from its mass matrix (composite rigid bodies) and a
/// Cholesky factorisation, with Lagrange multipliers for held points. One workspace per thread.
/// @throws std::invalid_argument that names a bad argument (size, not finite, no such link, so
/// large that the result is not finite); std::runtime_error if the mass matrix is not positive
/// definite (names the joint) or no acceleration meets the constraints of the held points (names
/// the point).
class ForwardDynamics {
 public:
  explicit ForwardDynamics(std::shared_ptr<const MultibodyModel> model,
                           const ForwardDynamicsSettings& settings = {});

  /// The dynamics at the current state. Only SetState of this class may change that state.
  MultibodyDynamics* dynamics() { return &dynamics_; }
  const MultibodyModel& model() const { return dynamics_.model(); }
  const ForwardDynamicsSettings& settings() const { return settings_; }

  void SetState(const Eigen::Ref<const Eigen::VectorXd>& q,
                const Eigen::Ref<const Eigen::VectorXd>& v);
  /// Acceleration under generalised forces (nv, without gravity); nv.
  const Eigen::VectorXd& Free(const Eigen::Ref<const Eigen::VectorXd>& forces);
  const ConstrainedMotion& Held(const Eigen::Ref<const Eigen::VectorXd>& forces,
                                const std::vector<HeldPoint>& points);
  /// Of the last Held, or of the last Free, at this state.
  ConstrainedResponse Response();
  /// Inelastic impact of all points at once: they are at rest afterwards.
  const Impact& Hit(const std::vector<ContactPoint>& points);

 private:
  void CheckForces(const Eigen::Ref<const Eigen::VectorXd>& forces) const;
  void CheckPoint(std::size_t index, const ContactPoint& point) const;
  std::string Described(std::size_t index, const ContactPoint& point) const;
  void RequireState() const;
  /// Factorises the mass matrix unless done already at this state.
  void Factor();
  void AccelerateFreely(const Eigen::Ref<const Eigen::VectorXd>& forces);
  /// Prepares the constraints of points: the Jacobian J, the basis Q of the velocities that rigid
  /// links can give them, and Y = L^-T J' Q. Q has so few columns that the Gram matrix Y'Y is small
  /// and, in most postures, regular.
  template <typename Points>
  void Constrain(const Points& points);
  /// The multipliers of least norm with J M^-1 J' lambda = required. `scale`: magnitude that the
  /// residual is compared with.
  template <typename Points>
  void SolveMultipliers(const Points& points, double scale, const char* unit);

  ForwardDynamicsSettings settings_;
  MultibodyDynamics dynamics_;
  BranchedCholesky mass_factor_;
  GramSolver gram_;
  bool has_state_ = false;
  bool has_factor_ = false;
  bool has_points_ = false;           // half_solved_ and gram_ are those of Held
  Eigen::VectorXd velocity_;          // nv
  Eigen::VectorXd bias_;              // nv, generalised forces at a = 0
  Eigen::VectorXd zero_;              // nv
  Eigen::VectorXd free_;              // nv, acceleration without constraints
  Eigen::VectorXd change_;            // nv, what the multipliers add to it
  std::vector<ContactPoint> points_;  // of the last constraints
  RigidBasis basis_;                  // Q, of points_
  Eigen::MatrixXd jacobians_;         // 3 points x nv: J
  Eigen::MatrixXd half_solved_;       // nv x columns of Q: Y
  Eigen::VectorXd required_;          // 3 points
  Eigen::VectorXd multipliers_;       // 3 points
  Eigen::VectorXd reduced_;           // columns of Q: the multipliers are Q times this
  Eigen::VectorXd unmet_;             // 3 points
  ConstrainedMotion motion_;
  Impact impact_;
};

}  // namespace possibility::dynamics
