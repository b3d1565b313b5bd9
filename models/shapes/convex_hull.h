#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace possibility::models {

/// A convex polytope with triangular facets, m.
struct ConvexHull {
  std::vector<Eigen::Vector3d> vertices;   ///< corners, each on a facet
  std::vector<std::array<int, 3>> facets;  ///< counter-clockwise as seen from outside

  double Volume() const;             ///< m^3
  Eigen::Vector3d Centroid() const;  ///< of the volume
  /// Mean over the volume of d d^T, d from the centroid, m^2.
  Eigen::Matrix3d Covariance() const;
  /// Distance of a point to the farthest plane of a facet: positive outside, negative inside.
  double Outside(const Eigen::Vector3d& point) const;
};

/// The hull of points by quickhull (Barber, Dobkin and Huhdanpaa 1996). Points within 1e-9 of the
/// points' extent of a facet count as on it.
/// @throws InputError if the points are not finite, or all lie within 1e-6 of their extent of one
/// plane.
ConvexHull HullOfPoints(const std::vector<Eigen::Vector3d>& points);

/// A hull of at most `most_vertices` (at least 4) that contains all points: quickhull stops there,
/// having taken the farthest points first, and the result is scaled about its centroid until it
/// contains the others. The exact hull if that has no more vertices.
/// @throws InputError as HullOfPoints.
ConvexHull SimpleHullOfPoints(const std::vector<Eigen::Vector3d>& points, int most_vertices);

}  // namespace possibility::models
