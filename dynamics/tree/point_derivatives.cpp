// First derivatives of points (docs/dynamics.md, "Points").
#include "dynamics/tree/tree_derivatives.h"

namespace possibility::dynamics {

using Eigen::Vector3d;

TreeDerivatives::PointMotion TreeDerivatives::MotionOf(int link, const Vector3d& p_L) const {
  const Vector3d p = kinematics_.Position(link, p_L) - kinematics_.X_WL()[0].translation();
  PointMotion point{link, p, VelocityAt(v_[link], p), VelocityAt(a_[link], p)};
  point.acceleration += v_[link].angular.cross(point.velocity);
  return point;
}

Vector3d TreeDerivatives::Position(int link, const Vector3d& p_L) const {
  return kinematics_.Position(link, p_L);
}

Vector3d TreeDerivatives::Velocity(int link, const Vector3d& p_L) const {
  return MotionOf(link, p_L).velocity + origin_velocity_;
}

Vector3d TreeDerivatives::Acceleration(int link, const Vector3d& p_L) const {
  return MotionOf(link, p_L).acceleration - Vector3d(0, 0, kGravity);
}

Vector3d TreeDerivatives::VelocityDerivative(const PointMotion& point, int coordinate) const {
  const Axis& axis = axes_[coordinate];
  return VelocityAt(axis.rate, point.p) + axis.S.angular.cross(point.velocity);
}

Vector3d TreeDerivatives::AccelerationDerivative(const PointMotion& point, int coordinate) const {
  const Axis& axis = axes_[coordinate];
  return axis.S.angular.cross(point.acceleration) + VelocityAt(axis.rate_rate, point.p) +
         2 * axis.rate.angular.cross(point.velocity);
}

const PointDerivatives& TreeDerivatives::DifferentiatePoint(int link, const Vector3d& p_L) {
  const PointMotion point = MotionOf(link, p_L);
  for (Eigen::MatrixXd* m :
       {&point_.jacobian, &point_.velocity_dq, &point_.acceleration_dq, &point_.acceleration_dv}) {
    m->setZero();
  }
  const auto fill = [&](int c) {
    const Axis& axis = axes_[c];
    point_.jacobian.col(c) = VelocityAt(axis.S, point.p);
    point_.velocity_dq.col(c) = VelocityDerivative(point, c);
    point_.acceleration_dq.col(c) = AccelerationDerivative(point, c);
    point_.acceleration_dv.col(c) =
        VelocityAt(axis.twice, point.p) + 2 * axis.S.angular.cross(point.velocity);
  };
  for (int c = 0; c < 3; ++c) fill(c);
  point_.jacobian.middleCols<3>(3).setIdentity();
  for (int i = link; i > 0; i = constants_[i].parent) fill(Coordinate(i));
  return point_;
}

void TreeDerivatives::AddPointForceDerivative(int link, const Vector3d& p_L, const Vector3d& f,
                                              Eigen::Ref<Eigen::MatrixXd> dq) const {
  CheckSize("a row of the derivative", dq.cols());
  CheckSize("a column of the derivative", dq.rows());
  const Vector3d p = kinematics_.Position(link, p_L) - kinematics_.X_WL()[0].translation();
  for (int i = link; i > 0; i = constants_[i].parent) {
    const int c = Coordinate(i);
    // The axis farther from the root moves the point; each axis before it turns that motion.
    const Vector3d moment = VelocityAt(axes_[c].S, p).cross(f);
    for (int j = i; j > 0; j = constants_[j].parent) {
      const int d = Coordinate(j);
      const double product = axes_[d].S.angular.dot(moment);
      dq(d, c) += product;
      if (d != c) dq(c, d) += product;
    }
    dq.col(c).head<3>() += moment;
    dq.row(c).head<3>() += moment;
  }
  for (int d = 0; d < 3; ++d) dq.col(d).head<3>() += Vector3d::Unit(d).cross(p).cross(f);
}

}  // namespace possibility::dynamics
