#include "dynamics/contact/compliant_ground.h"

#include <cmath>

namespace possibility::dynamics {

using Eigen::Matrix3d;
using Eigen::Vector3d;

GroundReaction ReactionOf(const CompliantGround& ground, double friction, const Vector3d& normal,
                          double gap, const Vector3d& velocity) {
  GroundReaction reaction;
  const double depth = -gap;
  const double approach = -normal.dot(velocity);
  const double damped = 1 + ground.dissipation * approach;
  if (depth <= 0 || damped <= 0) return reaction;
  const double load = ground.stiffness * depth * damped;
  const Vector3d sliding = velocity + approach * normal;
  const double scale = std::sqrt(sliding.squaredNorm() + ground.slip_speed * ground.slip_speed);
  const Vector3d per_load = normal - friction / scale * sliding;
  reaction.force = load * per_load;
  reaction.to_position = -ground.stiffness * damped * per_load * normal.transpose();
  const Matrix3d across = Matrix3d::Identity() - normal * normal.transpose();
  const Matrix3d turning = across - sliding * sliding.transpose() / (scale * scale);
  reaction.to_velocity =
      -ground.stiffness * depth * ground.dissipation * per_load * normal.transpose() -
      load * friction / scale * turning;
  return reaction;
}

}  // namespace possibility::dynamics
