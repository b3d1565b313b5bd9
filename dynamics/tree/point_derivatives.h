#pragma once

#include <Eigen/Core>

#include "dynamics/tree/tree_motion.h"

namespace possibility::dynamics {

/// The motion of a link's point relative to the root's origin, world axes.
struct PointMotion {
  int link;
  Eigen::Vector3d p;             ///< m
  Eigen::Vector3d velocity;      ///< m/s
  Eigen::Vector3d acceleration;  ///< m/s^2, gravity counted as an upward acceleration
};

PointMotion MotionOf(const TreeMotion& motion, int link, const Eigen::Vector3d& p_L);

/// Derivatives of a point's velocity and acceleration with respect to q along a coordinate that
/// moves the point and is no translation of the root (docs/dynamics.md, "Points").
Eigen::Vector3d VelocityDerivative(const TreeMotion& motion, const PointMotion& point,
                                   int coordinate);
Eigen::Vector3d AccelerationDerivative(const TreeMotion& motion, const PointMotion& point,
                                       int coordinate);

/// First derivatives of a point's velocity and acceleration, each 3 x nv, world axes. The
/// acceleration is J a + J-dot v: its derivatives at a = 0 are those of the bias.
struct PointDerivatives {
  Eigen::MatrixXd jacobian;         ///< d position / dq, d velocity / dv, d acceleration / da
  Eigen::MatrixXd velocity_dq;      ///< d velocity / dq
  Eigen::MatrixXd acceleration_dq;  ///< d acceleration / dq
  Eigen::MatrixXd acceleration_dv;  ///< d acceleration / dv
};

void DifferentiatePoint(const TreeMotion& motion, int link, const Eigen::Vector3d& p_L,
                        PointDerivatives* derivatives);

/// Adds the derivative of J' f with respect to q, f (world axes) held fixed, to `dq`: nv x nv.
void AddPointForceDerivative(const TreeMotion& motion, int link, const Eigen::Vector3d& p_L,
                             const Eigen::Vector3d& f, Eigen::Ref<Eigen::MatrixXd> dq);

}  // namespace possibility::dynamics
