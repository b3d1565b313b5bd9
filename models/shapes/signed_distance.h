#pragma once

#include <Eigen/Geometry>

#include "models/shapes/prepared_shape.h"

namespace possibility::models {

/// Signed distance between two convex shapes, m: their distance, or minus the length of the
/// shortest translation that separates them. `X_WA`, `X_WB`: poses of their core frames C.
///
/// The value is a lower bound that a separating direction proves. It is never too large; for shapes
/// of up to tens of metres it is too small by well under 0.05 mm. If the distance is `enough` or
/// more, any proven value of at least `enough` may be returned, which is faster. Minus infinity if
/// a pose is not finite.
double SignedDistance(const PreparedShape& A, const Eigen::Isometry3d& X_WA, const PreparedShape& B,
                      const Eigen::Isometry3d& X_WB, double enough);

/// A plane between two shapes, and how far apart it proves them to be.
struct SeparatingPlane {
  double distance = 0;  ///< as SignedDistance
  /// Unit, from A to B, in A's frame: A ends at support(A, normal), B begins `distance` beyond.
  Eigen::Vector3d normal_A = Eigen::Vector3d::UnitX();
};

/// The direction that proves SignedDistance.
SeparatingPlane Separate(const PreparedShape& A, const Eigen::Isometry3d& X_WA,
                         const PreparedShape& B, const Eigen::Isometry3d& X_WB);

}  // namespace possibility::models
