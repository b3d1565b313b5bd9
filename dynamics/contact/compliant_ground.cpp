#include "dynamics/contact/compliant_ground.h"

#include <cmath>

namespace possibility::dynamics {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

/// What ground bears, over the friction limit of which a point slides.
struct Load {
  double force = 0;   ///< N, along the normal; 0: does not bear
  double damped = 0;  ///< the factor of the spring's force
  Vector3d sliding = Vector3d::Zero();
  double scale = 0;  ///< m/s
  Vector3d per_load = Vector3d::Zero();
};

Load LoadOf(const CompliantGround& ground, double friction, const Vector3d& normal, double gap,
            const Vector3d& velocity) {
  Load load;
  const double approach = -normal.dot(velocity);
  load.damped = 1 + ground.dissipation * approach;
  if (gap >= 0 || load.damped <= 0) return load;
  load.force = ground.stiffness * -gap * load.damped;
  load.sliding = velocity + approach * normal;
  load.scale = std::sqrt(load.sliding.squaredNorm() + ground.slip_speed * ground.slip_speed);
  load.per_load = normal - friction / load.scale * load.sliding;
  return load;
}

}  // namespace

Vector3d ForceOf(const CompliantGround& ground, double friction, const Vector3d& normal, double gap,
                 const Vector3d& velocity) {
  const Load load = LoadOf(ground, friction, normal, gap, velocity);
  return load.force * load.per_load;
}

GroundReaction ReactionOf(const CompliantGround& ground, double friction, const Vector3d& normal,
                          double gap, const Vector3d& velocity) {
  GroundReaction reaction;
  const Load load = LoadOf(ground, friction, normal, gap, velocity);
  if (load.force == 0) return reaction;
  reaction.force = load.force * load.per_load;
  reaction.to_position = -ground.stiffness * load.damped * load.per_load * normal.transpose();
  const Matrix3d across = Matrix3d::Identity() - normal * normal.transpose();
  const Matrix3d turning =
      across - load.sliding * load.sliding.transpose() / (load.scale * load.scale);
  reaction.to_velocity =
      ground.stiffness * gap * ground.dissipation * load.per_load * normal.transpose() -
      load.force * friction / load.scale * turning;
  return reaction;
}

}  // namespace possibility::dynamics
