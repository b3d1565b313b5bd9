#include "dynamics/tree/point_derivatives.h"

namespace possibility::dynamics {

using Eigen::Vector3d;

PointMotion MotionOf(const TreeMotion& motion, int link, const Vector3d& p_L) {
  const Vector3d p =
      motion.kinematics().Position(link, p_L) - motion.kinematics().X_WL()[0].translation();
  PointMotion point{link, p, VelocityAt(motion.velocity(link), p),
                    VelocityAt(motion.acceleration(link), p)};
  point.acceleration += motion.velocity(link).angular.cross(point.velocity);
  return point;
}

Vector3d VelocityDerivative(const TreeMotion& motion, const PointMotion& point, int coordinate) {
  const TreeAxis& axis = motion.axis(coordinate);
  return VelocityAt(axis.rate, point.p) + axis.S.angular.cross(point.velocity);
}

Vector3d AccelerationDerivative(const TreeMotion& motion, const PointMotion& point,
                                int coordinate) {
  const TreeAxis& axis = motion.axis(coordinate);
  return axis.S.angular.cross(point.acceleration) + VelocityAt(axis.rate_rate, point.p) +
         2 * axis.rate.angular.cross(point.velocity);
}

void DifferentiatePoint(const TreeMotion& motion, int link, const Vector3d& p_L,
                        PointDerivatives* derivatives) {
  const PointMotion point = MotionOf(motion, link, p_L);
  for (Eigen::MatrixXd* m : {&derivatives->jacobian, &derivatives->velocity_dq,
                             &derivatives->acceleration_dq, &derivatives->acceleration_dv}) {
    m->setZero(3, motion.kinematics().model().nv());
  }
  const auto fill = [&](int c) {
    const TreeAxis& axis = motion.axis(c);
    derivatives->jacobian.col(c) = VelocityAt(axis.S, point.p);
    derivatives->velocity_dq.col(c) = VelocityDerivative(motion, point, c);
    derivatives->acceleration_dq.col(c) = AccelerationDerivative(motion, point, c);
    derivatives->acceleration_dv.col(c) =
        VelocityAt(axis.twice, point.p) + 2 * axis.S.angular.cross(point.velocity);
  };
  for (int c = 0; c < 3; ++c) fill(c);
  derivatives->jacobian.middleCols<3>(3).setIdentity();
  for (int i = link; i > 0; i = motion.parent(i)) fill(TreeMotion::Coordinate(i));
}

void AddPointForceDerivative(const TreeMotion& motion, int link, const Vector3d& p_L,
                             const Vector3d& f, Eigen::Ref<Eigen::MatrixXd> dq) {
  motion.CheckSize("a row of the derivative", dq.cols());
  motion.CheckSize("a column of the derivative", dq.rows());
  const Vector3d p =
      motion.kinematics().Position(link, p_L) - motion.kinematics().X_WL()[0].translation();
  for (int i = link; i > 0; i = motion.parent(i)) {
    const int c = TreeMotion::Coordinate(i);
    // The axis farther from the root moves the point; each axis before it turns that motion.
    const Vector3d moment = VelocityAt(motion.axis(c).S, p).cross(f);
    for (int j = i; j > 0; j = motion.parent(j)) {
      const int d = TreeMotion::Coordinate(j);
      const double product = motion.axis(d).S.angular.dot(moment);
      dq(d, c) += product;
      if (d != c) dq(c, d) += product;
    }
    dq.col(c).head<3>() += moment;
    dq.row(c).head<3>() += moment;
  }
  for (int d = 0; d < 3; ++d) dq.col(d).head<3>() += Vector3d::Unit(d).cross(p).cross(f);
}

}  // namespace possibility::dynamics
