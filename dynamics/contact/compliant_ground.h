#pragma once

#include <Eigen/Core>

namespace possibility::dynamics {

/// Ground that gives a little, and on which points slide: Hunt and Crossley's (1975) damped spring
/// along the normal, Coulomb friction across it. A point that slides slower than about `slip_speed`
/// bears less than the friction limit; so a point that bears a constant force creeps.
struct CompliantGround {
  double stiffness = 1e6;    ///< N/m, of a point
  double dissipation = 50;   ///< s/m: share of the spring's force that is added per speed
  double slip_speed = 2e-4;  ///< m/s, at 0.7 of the limit of friction
};

/// Force of the ground on a point, and its derivatives with respect to the point's position and
/// velocity. World axes; N, N/m, N s/m.
struct GroundReaction {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  Eigen::Matrix3d to_position = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d to_velocity = Eigen::Matrix3d::Zero();
};

/// Its force alone.
Eigen::Vector3d ForceOf(const CompliantGround& ground, double friction,
                        const Eigen::Vector3d& normal, double gap, const Eigen::Vector3d& velocity);

/// `gap`: m, of the point above the ground; `normal`: of the ground, unit; `velocity`: m/s. Zero
/// above the ground; the ground never pulls.
GroundReaction ReactionOf(const CompliantGround& ground, double friction,
                          const Eigen::Vector3d& normal, double gap,
                          const Eigen::Vector3d& velocity);

}  // namespace possibility::dynamics
