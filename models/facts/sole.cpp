#include "models/facts/sole.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "models/mesh/convex_merge.h"

namespace possibility::models {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Points of the surface, in W's axes about the link's origin, among them the lowest.
std::vector<Vector3d> LowPoints(const PosedShape& posed, const Eigen::Matrix3d& R_WL) {
  const Eigen::Isometry3d X = Eigen::Isometry3d(R_WL) * posed.X_PS;
  const Shape& shape = posed.shape;
  std::vector<Vector3d> points;
  const auto add = [&](const Vector3d& p) { points.push_back(X * p); };
  const Vector3d down = X.linear().transpose() * -Vector3d::UnitZ();
  constexpr int kRim = 24;
  switch (shape.type) {
    case ShapeType::kBox:
      for (int i = 0; i < 8; ++i) {
        add(Vector3d(i & 1 ? 0.5 : -0.5, i & 2 ? 0.5 : -0.5, i & 4 ? 0.5 : -0.5)
                .cwiseProduct(shape.size));
      }
      break;
    case ShapeType::kSphere:
      add(shape.radius * down);
      break;
    case ShapeType::kCapsule:
      for (const double side : {-0.5, 0.5}) {
        add(Vector3d(0, 0, side * shape.length) + shape.radius * down);
      }
      break;
    case ShapeType::kCylinder:
      for (int i = 0; i < 2 * kRim; ++i) {
        const double angle = 2 * std::numbers::pi * (i / 2) / kRim;
        add({shape.radius * std::cos(angle), shape.radius * std::sin(angle),
             (i % 2 - 0.5) * shape.length});
      }
      add(shape.Support(down));
      break;
    case ShapeType::kConvexMesh:
      for (const Vector3d& vertex : shape.vertices) add(vertex);
  }
  return points;
}

double TriangleArea(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  return 0.5 * std::abs((b - a).x() * (c - a).y() - (b - a).y() * (c - a).x());
}

void LeaveOutCorners(int most, ConvexPolygon* polygon) {
  while (static_cast<int>(polygon->size()) > most) {
    const std::size_t n = polygon->size();
    std::size_t cheapest = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < n; ++i) {
      const double cost =
          TriangleArea((*polygon)[(i + n - 1) % n], (*polygon)[i], (*polygon)[(i + 1) % n]);
      if (cost < least) {
        least = cost;
        cheapest = i;
      }
    }
    polygon->erase(polygon->begin() + static_cast<std::ptrdiff_t>(cheapest));
  }
}

}  // namespace

Sole SoleOf(const Link& link, const Eigen::Matrix3d& R_WL, double slack, int most_corners) {
  std::vector<Vector3d> points;
  for (const PosedShape& posed : link.shapes) {
    const std::vector<Vector3d> more = LowPoints(posed, R_WL);
    points.insert(points.end(), more.begin(), more.end());
  }
  double lowest = std::numeric_limits<double>::infinity();
  for (const Vector3d& p : points) lowest = std::min(lowest, p.z());
  Sole sole;
  std::vector<Vector2d> low;
  for (const Vector3d& p : points) {
    if (p.z() > lowest + slack) continue;
    low.push_back(p.head<2>());
    sole.depth = std::max(sole.depth, p.z() - lowest);
  }
  if (low.empty()) return sole;
  constexpr double kRounding = 1e-6;  // m
  ConvexPolygon polygon = low.size() < 3 ? ConvexPolygon(low) : HullOf(low, kRounding);
  LeaveOutCorners(most_corners, &polygon);
  if (polygon.size() >= 3) sole.area = AreaOf(polygon);
  for (const Vector2d& p : polygon) {
    sole.points.push_back(R_WL.transpose() * Vector3d(p.x(), p.y(), lowest));
  }
  return sole;
}

}  // namespace possibility::models
