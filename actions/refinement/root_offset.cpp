#include "actions/refinement/root_offset.h"

#include <Eigen/LU>

#include "models/robot/rotation_vector.h"

namespace possibility::actions {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

Quaterniond RootTurn(const Eigen::VectorXd& q) {
  return Quaterniond(q[0], q[1], q[2], q[3]).normalized();
}

}  // namespace

Knot Moved(const Knot& knot, const RootOffset& offset) {
  const Vector3d theta = offset.value.head<3>();
  const Vector3d theta_rate = offset.rate.head<3>();
  const Matrix3d E = models::Exponential(theta).toRotationMatrix();
  const Matrix3d J = models::LeftJacobian(theta);
  const Vector3d turning = J * theta_rate;
  const Vector3d omega = E * knot.v.head<3>();
  Knot moved = knot;
  const Quaterniond R = models::Exponential(theta) * RootTurn(knot.q);
  moved.q.head<4>() << R.w(), R.vec();
  moved.q.segment<3>(4) += offset.value.tail<3>();
  moved.v.head<3>() = turning + omega;
  moved.v.segment<3>(3) += offset.rate.tail<3>();
  moved.a.head<3>() = J * offset.acceleration.head<3>() +
                      models::LeftJacobianRate(theta, theta_rate) * theta_rate +
                      turning.cross(omega) + E * knot.a.head<3>();
  moved.a.segment<3>(3) += offset.acceleration.tail<3>();
  return moved;
}

Vector6d OffsetAcceleration(const RootOffset& offset, const Vector6d& change) {
  Vector6d acceleration = change;
  acceleration.head<3>() =
      models::LeftJacobian(offset.value.head<3>()).inverse() * change.head<3>();
  return acceleration;
}

RootOffset OffsetBetween(const Knot& plan, const Knot& moved) {
  RootOffset offset;
  const Vector3d theta = models::RotationVector(RootTurn(moved.q) * RootTurn(plan.q).conjugate());
  const Vector3d omega = models::Exponential(theta).toRotationMatrix() * plan.v.head<3>();
  offset.value << theta, moved.q.segment<3>(4) - plan.q.segment<3>(4);
  offset.rate << models::LeftJacobian(theta).inverse() * (moved.v.head<3>() - omega),
      moved.v.segment<3>(3) - plan.v.segment<3>(3);
  return offset;
}

RootOffset Faded(const RootOffset& begin, double duration, double s) {
  // 1 - 10 s^3 + 15 s^4 - 6 s^5 and s - 6 s^3 + 8 s^4 - 3 s^5 begin with value and rate 1.
  const double r = 1 - s;
  const double of_value = r * r * r * (1 + 3 * s + 6 * s * s);
  const double of_value_1 = -30 * s * s * r * r;
  const double of_value_2 = -60 * s * r * (1 - 2 * s);
  const double of_rate = s * r * r * r * (1 + 3 * s);
  const double of_rate_1 = r * r * (1 - 3 * s) * (1 + 5 * s);
  const double of_rate_2 = -36 * s + 96 * s * s - 60 * s * s * s;
  RootOffset offset;
  offset.value = of_value * begin.value + of_rate * duration * begin.rate;
  offset.rate = of_value_1 / duration * begin.value + of_rate_1 * begin.rate;
  offset.acceleration =
      of_value_2 / (duration * duration) * begin.value + of_rate_2 / duration * begin.rate;
  return offset;
}

}  // namespace possibility::actions
