#include "actions/spatial/core_corners.h"

#include <Eigen/Geometry>

namespace possibility::actions {

using Eigen::Vector3d;
using models::ShapeType;

std::vector<Vector3d> CoreCorners(const models::Shape& shape) {
  switch (shape.type) {
    case ShapeType::kSphere:
      return {Vector3d::Zero()};
    case ShapeType::kCapsule:
      return {Vector3d(0, 0, shape.length / 2), Vector3d(0, 0, -shape.length / 2)};
    case ShapeType::kConvexMesh:
      return shape.vertices;
    case ShapeType::kBox:
    case ShapeType::kCylinder:
      break;
  }
  // A cylinder's bounding box contains it.
  const Eigen::AlignedBox3d box = shape.Bounds(Eigen::Isometry3d::Identity());
  constexpr int kCorners = 8;
  std::vector<Vector3d> corners;
  corners.reserve(kCorners);
  for (int i = 0; i < kCorners; ++i) {
    corners.push_back(box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i)));
  }
  return corners;
}

}  // namespace possibility::actions
