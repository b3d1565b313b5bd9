#pragma once

#include <Eigen/Core>
#include <vector>

namespace possibility::dynamics {

/// Points that may bear on the ground, and their motion if none of them did.
struct UnilateralContacts {
  Eigen::MatrixXd mass;                  ///< nv x nv
  Eigen::MatrixXd jacobian;              ///< 3 points x nv, world axes
  Eigen::VectorXd unconstrained;         ///< 3 points: accelerations (or velocities, for an impact)
  std::vector<Eigen::Vector3d> normals;  ///< unit, out of the ground; one per point
  /// A point that leaves the ground more slowly than this (or within rounding) stays.
  double staying = 0;
};

/// Which points bear: indices into the points of UnilateralContacts.
struct BearingSelection {
  std::vector<int> points;  ///< ascending
  /// Ascending, a subset of `points`: those that friction jams. If held they must pull; if released
  /// they would enter the ground. Only sliding, which is not simulated, could resolve this
  /// (Painleve 1895).
  std::vector<int> jammed;
};

/// Selects the points that bear: Gauss's principle of least constraint with unilateral normals
/// (Moreau 1966; for velocities the inelastic impact of Moreau 1988). Of all motions in which no
/// point enters the ground or slides on it, the principle picks the one nearest to the
/// unconstrained motion in the metric of the mass matrix. Its dual asks for forces with normal
/// parts >= 0. A point that leaves the ground in this motion does not bear, and may then also
/// slide: it is removed, put back if it would then enter the ground, and the rest is solved again.
/// If this cycles and there are at most ten points, all subsets are tried. If no subset fits,
/// points jam. Points at rest bear even if others could carry their share.
/// @throws std::invalid_argument if sizes disagree or a number is not finite.
BearingSelection SelectBearingPoints(const UnilateralContacts& contacts);

}  // namespace possibility::dynamics
