#pragma once

#include <Eigen/Core>
#include <vector>

namespace possibility::dynamics {

/// Points that may bear on the ground, and how they would move if none did.
struct UnilateralContacts {
  Eigen::MatrixXd mass;                  ///< nv x nv
  Eigen::MatrixXd jacobian;              ///< 3 points x nv, world axes
  Eigen::VectorXd unconstrained;         ///< 3 points: accelerations (or velocities, for an impact)
  std::vector<Eigen::Vector3d> normals;  ///< unit, out of the ground; one per point
  /// A point that leaves the ground more slowly than this (or by no more than rounding) stays.
  double staying = 0;
};

struct BearingPoints {
  std::vector<int> points;  ///< ascending
  /// Ascending, a part of them: those that friction jams. Held they have to pull, let go they would
  /// enter the ground; only sliding, which is not simulated, could resolve it (Painleve 1895).
  std::vector<int> jammed;
};

/// Which of the points bear: Gauss's principle of least constraint with unilateral normals
/// (Moreau 1966; for velocities the inelastic impact of Moreau 1988). Of all motions in which no
/// point enters the ground or slides on it, the one nearest to the unconstrained motion in the
/// metric of the mass matrix; its dual asks for forces with normal parts >= 0. A point that leaves
/// the ground in this motion does not bear, and then may also slide: it is taken out, put back if
/// it then would enter the ground, and the rest solved again. Where that goes round in circles, all
/// sets of at most ten points are tried. Points at rest bear even if others could carry their
/// share.
/// @throws std::invalid_argument if sizes disagree or a number is not finite.
BearingPoints SelectBearingPoints(const UnilateralContacts& contacts);

}  // namespace possibility::dynamics
