#pragma once

#include <Eigen/Core>

#include "dynamics/tree/tree_kinematics.h"

namespace possibility::dynamics {

/// Inverse dynamics at the state of `kinematics`, link by link: the wrenches of Newton's and
/// Euler's equations at the centres of mass, projected by their Jacobians. Slow, and independent of
/// the recursion.
inline Eigen::VectorXd NewtonEuler(const TreeKinematics& kinematics, const Eigen::VectorXd& a) {
  const models::RobotModel& model = kinematics.model();
  Eigen::VectorXd forces = Eigen::VectorXd::Zero(model.nv());
  Eigen::MatrixXd J;
  for (int i = 0; i < model.num_links(); ++i) {
    const models::Inertial& inertial = model.links[i].inertial;
    const Eigen::Matrix3d R = kinematics.X_WL()[i].linear();
    const Eigen::Matrix3d I = R * inertial.I_LC * R.transpose();
    const Eigen::Vector3d w = kinematics.AngularVelocity(i);
    kinematics.FrameJacobian(i, inertial.p_LC, &J);
    const Eigen::Matrix<double, 6, 1> motion = J * a + kinematics.FrameBias(i, inertial.p_LC);
    Eigen::Matrix<double, 6, 1> wrench;
    wrench << I * motion.head<3>() + w.cross(I * w),
        inertial.mass * (motion.tail<3>() + Eigen::Vector3d(0, 0, kGravity));
    forces += J.transpose() * wrench;
  }
  return forces;
}

}  // namespace possibility::dynamics
