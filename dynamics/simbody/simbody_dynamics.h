#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "dynamics/tree/contact_point.h"
#include "models/robot/robot_model.h"

namespace possibility::dynamics {

/// The robot as a Simbody multibody system with its State: the reference for tests of our own
/// recursions, and the engine of the verifier. One instance per thread (a shared system aborts in
/// forward dynamics). Conventions of q, v, a: models::RobotModel; of generalised forces:
/// TreeKinematics.
///
/// Actuators: their rotors and friction are in inverse dynamics, the mass matrix, the kinetic
/// energy and forward dynamics, where each rotor is a body of its own that a constraint turns with
/// its joint.
///
/// Mimic joints: inverse dynamics, the mass matrix and Jacobians are those of the tree, where every
/// joint is independent. Forward dynamics holds mimic joints to their masters by constraints.
///
/// @throws std::invalid_argument that names an argument of wrong size, that is not finite (forces,
/// held points) or a link out of range.
class SimbodyDynamics {
 public:
  explicit SimbodyDynamics(const models::RobotModel& model);
  ~SimbodyDynamics();
  SimbodyDynamics(SimbodyDynamics&&) noexcept;

  void SetState(const Eigen::Ref<const Eigen::VectorXd>& q,
                const Eigen::Ref<const Eigen::VectorXd>& v);

  /// M(q) a + c(q, v) + g(q), gravity included; nv.
  Eigen::VectorXd InverseDynamics(const Eigen::Ref<const Eigen::VectorXd>& a) const;
  Eigen::MatrixXd MassMatrix() const;  ///< nv x nv

  /// The motion of the robot while points of it are held.
  struct HeldMotion {
    Eigen::VectorXd acceleration;  ///< nv
    Eigen::Matrix3Xd forces;       ///< 3 x points, on the robot, world axes, N
  };
  /// Acceleration under generalised forces (without gravity); nv.
  Eigen::VectorXd ForwardDynamics(const Eigen::Ref<const Eigen::VectorXd>& forces);
  /// The same with points held by ball joints to the ground: their acceleration is zero, whatever
  /// their velocity. If a rigid body does not determine how points share a load, or the points
  /// contradict each other, Simbody decides (least squares).
  HeldMotion ForwardDynamics(const Eigen::Ref<const Eigen::VectorXd>& forces,
                             const std::vector<ContactPoint>& held);

  double KineticEnergy() const;    ///< J
  double PotentialEnergy() const;  ///< J, 0 with the centre of mass at z = 0
  /// About the centre of mass: rows 0-2 angular (kg m^2/s), 3-5 linear (kg m/s), world axes.
  Eigen::Matrix<double, 6, 1> CentroidalMomentum() const;

  Eigen::Isometry3d LinkPose(int link) const;
  Eigen::Vector3d PointPosition(int link, const Eigen::Vector3d& p_L) const;
  Eigen::Vector3d PointVelocity(int link, const Eigen::Vector3d& p_L) const;
  Eigen::Matrix3Xd PointJacobian(int link, const Eigen::Vector3d& p_L) const;  ///< 3 x nv
  /// J-dot v of PointJacobian.
  Eigen::Vector3d PointBias(int link, const Eigen::Vector3d& p_L) const;
  Eigen::Vector3d CentreOfMass() const;
  Eigen::Vector3d CentreOfMassVelocity() const;

 private:
  struct System;
  /// Points held to the ground, by link. Simbody's constraints are built for them.
  struct HeldSystem;

  models::RobotModel model_;
  Eigen::VectorXd q_;
  Eigen::VectorXd v_;
  /// What friction leaves of generalised forces.
  Eigen::VectorXd WithoutFriction(const Eigen::Ref<const Eigen::VectorXd>& forces) const;

  std::unique_ptr<System> free_;
  std::unique_ptr<System> driven_;    ///< with rotors; null if there are none
  std::unique_ptr<HeldSystem> held_;  ///< for the last links held
};

}  // namespace possibility::dynamics
