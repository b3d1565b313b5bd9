#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace possibility::models {

/// The rotation vector phi (rad, length 0 to pi) of a rotation: exp([phi]).
Eigen::Vector3d RotationVector(const Eigen::Quaterniond& rotation);
Eigen::Vector3d RotationVector(const Eigen::Matrix3d& rotation);

/// exp([phi]): the rotation about phi by its length.
Eigen::AngleAxisd Exponential(const Eigen::Vector3d& phi);

/// The smallest rotation that turns `from` into the direction of `to`; half a turn about some axis
/// across them if they are opposite. Neither may be zero. Unlike Eigen's it needs no singular
/// values: those are compiled anew in every file that asks for them.
Eigen::Quaterniond SmallestRotation(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

/// Left Jacobian of SO(3): the angular velocity (world axes) of R(t) = exp([phi(t)]) R0 is
/// LeftJacobian(phi) * phi-dot (Chirikjian 2012, Stochastic Models, eq. 10.86).
Eigen::Matrix3d LeftJacobian(const Eigen::Vector3d& phi);

/// Time derivative of LeftJacobian along phi-dot.
Eigen::Matrix3d LeftJacobianRate(const Eigen::Vector3d& phi, const Eigen::Vector3d& phi_rate);

}  // namespace possibility::models
