#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "models/robot/robot_model.h"

namespace possibility::dynamics {

/// Recursive kinematics of a floating-base tree (docs/dynamics.md). Vectors are kept in world axes,
/// each link's about its own origin. Nothing is allocated after construction except what a function
/// returns. One workspace per thread; the model must outlive it. Conventions of q, v, a:
/// models::RobotModel.
///
/// Generalised forces are dual to v: torque on the root about the root's origin, force on the
/// root (both world axes), joint torques.
///
/// Sizes are checked: @throws std::invalid_argument if a vector's size does not fit the model, or
/// the quaternion in `q` cannot be normalised.
class TreeKinematics {
 public:
  explicit TreeKinematics(const models::RobotModel& model);

  const models::RobotModel& model() const { return *model_; }

  /// Sets the poses. `q`: nq; its quaternion is normalised here.
  void SetPosition(const Eigen::Ref<const Eigen::VectorXd>& q);
  /// Sets velocities and velocity-product accelerations at the last position. `v`: nv.
  void SetVelocity(const Eigen::Ref<const Eigen::VectorXd>& v);

  const std::vector<Eigen::Isometry3d>& X_WL() const { return X_WL_; }
  Eigen::Vector3d Position(int link, const Eigen::Vector3d& p_L) const;
  Eigen::Vector3d Velocity(int link, const Eigen::Vector3d& p_L) const;
  Eigen::Vector3d AngularVelocity(int link) const;

  /// Unit axis of the joint that moves a link (not the root), world axes.
  const Eigen::Vector3d& Axis(int link) const { return states_[link].axis; }
  /// The joints between the root and a link, the root's first: all joints that move the link.
  const std::vector<int>& SupportingJoints(int link) const { return supporting_joints_[link]; }

  /// Rows 0-2 angular, 3-5 linear velocity of the point; 6 x nv, world axes. `J` is resized if
  /// it has another size.
  void FrameJacobian(int link, const Eigen::Vector3d& p_L, Eigen::MatrixXd* J) const;
  /// The linear rows alone, written into `J`: 3 x nv, for example a block of a larger matrix.
  void PointJacobian(int link, const Eigen::Vector3d& p_L, Eigen::Ref<Eigen::MatrixXd> J) const;
  /// The angular rows alone, written into `J`: 3 x nv.
  void AngularJacobian(int link, Eigen::Ref<Eigen::MatrixXd> J) const;
  /// J-dot v of FrameJacobian (needs SetVelocity).
  Eigen::Matrix<double, 6, 1> FrameBias(int link, const Eigen::Vector3d& p_L) const;

  double total_mass() const { return constants_.front().subtree_mass; }
  Eigen::Vector3d CentreOfMass() const;
  Eigen::Vector3d CentreOfMassVelocity() const;
  void CentreOfMassJacobian(Eigen::MatrixXd* J) const;  ///< 3 x nv
  Eigen::Vector3d CentreOfMassBias() const;             ///< J-dot v

  /// Adds J' f of a force `f_W` (world axes) acting at a link point to `generalised` (nv).
  void AddPointForce(int link, const Eigen::Vector3d& p_L, const Eigen::Vector3d& f_W,
                     Eigen::VectorXd* generalised) const;

 private:
  /// Model constants of a link and, unless it is the root, of the joint that moves it.
  struct LinkConstants {
    int parent = -1;
    bool prismatic = false;
    Eigen::Vector3d p_PJ = Eigen::Vector3d::Zero();
    Eigen::Vector3d axis_P = Eigen::Vector3d::Zero();
    /// The child's rotation in its parent at joint angle t: fixed + sin t * sine
    /// + (1 - cos t) * versine (Rodrigues' formula, multiplied out).
    Eigen::Matrix3d fixed = Eigen::Matrix3d::Identity();
    Eigen::Matrix3d sine = Eigen::Matrix3d::Zero();
    Eigen::Matrix3d versine = Eigen::Matrix3d::Zero();
    double mass = 0;
    double subtree_mass = 0;
    Eigen::Vector3d p_LC = Eigen::Vector3d::Zero();
  };

  /// World axes throughout.
  struct LinkState {
    // Position.
    Eigen::Vector3d axis = Eigen::Vector3d::Zero();
    Eigen::Vector3d from_parent = Eigen::Vector3d::Zero();     ///< origin minus parent's origin
    Eigen::Vector3d to_com = Eigen::Vector3d::Zero();          ///< com minus origin
    Eigen::Vector3d subtree_moment = Eigen::Vector3d::Zero();  ///< sum of mass * com position
    // Velocity.
    Eigen::Vector3d angular = Eigen::Vector3d::Zero();
    Eigen::Vector3d linear = Eigen::Vector3d::Zero();
    /// What the joint adds to the parent's acceleration at zero joint acceleration.
    Eigen::Vector3d joint_angular_bias = Eigen::Vector3d::Zero();
    Eigen::Vector3d joint_linear_bias = Eigen::Vector3d::Zero();
    /// Acceleration at a = 0.
    Eigen::Vector3d angular_bias = Eigen::Vector3d::Zero();
    Eigen::Vector3d linear_bias = Eigen::Vector3d::Zero();
  };

  void PlaceLink(int link, double joint_position);
  void MoveLink(int link, double joint_rate);

  const models::RobotModel* model_;
  std::vector<Eigen::Isometry3d> X_WL_;
  std::vector<LinkConstants> constants_;
  std::vector<LinkState> states_;
  std::vector<std::vector<int>> supporting_joints_;
};

/// Standard gravity, m/s^2, along -z.
inline constexpr double kGravity = 9.80665;

}  // namespace possibility::dynamics
