#pragma once

#include <Eigen/Core>
#include <vector>

#include "models/robot/robot_model.h"

namespace possibility::dynamics {

/// What rotors and friction of a tree's joints add to its dynamics (docs/dynamics.md,
/// "Actuators"), by coordinate of the tree's v. Nothing for a robot without actuators. One
/// workspace per thread.
class ActuatorTorques {
 public:
  explicit ActuatorTorques(const models::RobotModel& model);

  bool empty() const { return joints_.empty(); }

  /// `v`: nv; checked by the caller, as all sizes below.
  void SetVelocity(const Eigen::Ref<const Eigen::VectorXd>& v);
  void SetAcceleration(const Eigen::Ref<const Eigen::VectorXd>& a);

  /// Adds the torques at the velocity and acceleration set to generalised forces, nv.
  void AddTorques(Eigen::VectorXd* forces) const;
  /// Adds the armatures to a mass matrix, nv x nv.
  void AddInertia(Eigen::MatrixXd* mass_matrix) const;
  /// Adds the derivatives of the torques with respect to v and a, nv x nv each.
  void AddDerivatives(Eigen::MatrixXd* dv, Eigen::MatrixXd* da) const;
  /// Adds the second derivative of lambda' torques with respect to v, nv x nv; `lambda`: nv.
  void AddHessian(const Eigen::Ref<const Eigen::VectorXd>& lambda, Eigen::MatrixXd* vv) const;

 private:
  struct ActuatedJoint {
    int coordinate = 0;
    models::Actuator actuator;
    double speed = 0;         // rad/s or m/s
    double acceleration = 0;  // rad/s^2 or m/s^2
  };

  std::vector<ActuatedJoint> joints_;  // those whose actuator takes torque
};

}  // namespace possibility::dynamics
