#include "models/mesh/triangle_mesh.h"

namespace possibility::models {

Eigen::Vector3d TriangleMesh::AreaVector(int triangle) const {
  const auto& [a, b, c] = triangles[triangle];
  return (vertices[b] - vertices[a]).cross(vertices[c] - vertices[a]);
}

Eigen::AlignedBox3d TriangleMesh::Bounds() const {
  Eigen::AlignedBox3d bounds;
  for (const Eigen::Vector3d& vertex : vertices) bounds.extend(vertex);
  return bounds;
}

TriangleMesh TriangleMesh::Placed(double scale, const Eigen::Isometry3d& X_WM) const {
  TriangleMesh placed = *this;
  for (Eigen::Vector3d& vertex : placed.vertices) vertex = X_WM * (scale * vertex);
  return placed;
}

}  // namespace possibility::models
