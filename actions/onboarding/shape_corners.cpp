#include "actions/onboarding/shape_corners.h"

#include <cmath>
#include <numbers>

namespace possibility::actions {
namespace {

using Eigen::Vector3d;
using models::PosedShape;

std::vector<Vector3d> CornersOfShape(const PosedShape& posed) {
  const models::Shape& shape = posed.shape;
  std::vector<Vector3d> corners;
  if (shape.type == models::ShapeType::kConvexMesh) {
    corners = shape.vertices;
  } else if (shape.type == models::ShapeType::kBox) {
    for (int i = 0; i < 8; ++i) {
      corners.push_back(Vector3d(i & 1 ? 0.5 : -0.5, i & 2 ? 0.5 : -0.5, i & 4 ? 0.5 : -0.5)
                            .cwiseProduct(shape.size));
    }
  } else {
    constexpr int kSides = 12;
    const bool is_round = shape.type != models::ShapeType::kCylinder;
    const double half = 0.5 * shape.length + (is_round ? shape.radius : 0);
    const double radius = shape.radius / std::cos(std::numbers::pi / kSides);
    for (int i = 0; i < 2 * kSides; ++i) {
      const double angle = 2 * std::numbers::pi * (i / 2) / kSides;
      corners.emplace_back(radius * std::cos(angle), radius * std::sin(angle),
                           i % 2 ? half : -half);
    }
  }
  for (Vector3d& corner : corners) corner = posed.X_PS * corner;
  return corners;
}

}  // namespace

std::vector<Vector3d> CornersOf(const std::vector<PosedShape>& shapes) {
  std::vector<Vector3d> corners;
  for (const PosedShape& posed : shapes) {
    const std::vector<Vector3d> more = CornersOfShape(posed);
    corners.insert(corners.end(), more.begin(), more.end());
  }
  return corners;
}

}  // namespace possibility::actions
