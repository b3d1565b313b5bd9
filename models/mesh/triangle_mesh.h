#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <vector>

namespace possibility::models {

/// A surface of triangles, m. The corners of a triangle go counter-clockwise as seen from outside.
struct TriangleMesh {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::array<int, 3>> triangles;  ///< indices of vertices

  /// Twice the triangle's area, along its normal, m^2.
  Eigen::Vector3d AreaVector(int triangle) const;

  Eigen::AlignedBox3d Bounds() const;

  /// Scales about the origin and then moves.
  TriangleMesh Placed(double scale, const Eigen::Isometry3d& X_WM) const;
};

/// More than this are refused: the robot's collision queries would need gigabytes.
inline constexpr std::size_t kMostTriangles = 200000;

}  // namespace possibility::models
