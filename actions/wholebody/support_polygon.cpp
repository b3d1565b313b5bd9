#include "actions/wholebody/support_polygon.h"

#include <algorithm>
#include <limits>

namespace possibility::actions {
namespace {

using Eigen::Vector2d;
using Polygon = std::vector<Vector2d>;

double Cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Andrew's monotone chain.
Polygon ConvexHull(Polygon points) {
  std::sort(points.begin(), points.end(), [](const Vector2d& a, const Vector2d& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  });
  Polygon hull;
  const auto add_chain = [&hull](auto begin, auto end) {
    const size_t base = hull.size();
    for (auto p = begin; p != end; ++p) {
      while (hull.size() >= base + 2 &&
             Cross(hull.back() - hull[hull.size() - 2], *p - hull.back()) <= 0) {
        hull.pop_back();
      }
      hull.push_back(*p);
    }
    hull.pop_back();
  };
  if (points.size() < 3) return points;
  add_chain(points.begin(), points.end());
  add_chain(points.rbegin(), points.rend());
  return hull;
}

/// Signed distance of p to the left of the line through a and b.
double LeftOf(const Vector2d& a, const Vector2d& b, const Vector2d& p) {
  const Vector2d edge = b - a;
  return Cross(edge, p - a) / edge.norm();
}

/// The part of `polygon` at least `margin` to the left of the line through a and b.
Polygon Clip(const Polygon& polygon, const Vector2d& a, const Vector2d& b, double margin) {
  Polygon result;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d& p = polygon[i];
    const Vector2d& next = polygon[(i + 1) % polygon.size()];
    const double dp = LeftOf(a, b, p) - margin;
    const double dnext = LeftOf(a, b, next) - margin;
    if (dp >= 0) result.push_back(p);
    if ((dp >= 0) != (dnext >= 0)) result.push_back(p + dp / (dp - dnext) * (next - p));
  }
  return result;
}

Vector2d NearestOnSegment(const Vector2d& a, const Vector2d& b, const Vector2d& p) {
  const double length2 = (b - a).squaredNorm();
  if (length2 == 0) return a;
  return a + std::clamp((p - a).dot(b - a) / length2, 0.0, 1.0) * (b - a);
}

Vector2d NearestOnBoundary(const Polygon& polygon, const Vector2d& p) {
  Vector2d best = polygon.front();
  for (size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d q = NearestOnSegment(polygon[i], polygon[(i + 1) % polygon.size()], p);
    if ((q - p).squaredNorm() < (best - p).squaredNorm()) best = q;
  }
  return best;
}

}  // namespace

SupportPolygon::SupportPolygon(const std::vector<Vector2d>& points)
    : vertices_(ConvexHull(points)) {}

double SupportPolygon::Margin(const Vector2d& p) const {
  if (vertices_.empty()) return -std::numeric_limits<double>::infinity();
  if (vertices_.size() < 3) return -(NearestOnBoundary(vertices_, p) - p).norm();
  double margin = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < vertices_.size(); ++i) {
    margin = std::min(margin, LeftOf(vertices_[i], vertices_[(i + 1) % vertices_.size()], p));
  }
  return margin >= 0 ? margin : -(NearestOnBoundary(vertices_, p) - p).norm();
}

Polygon SupportPolygon::Shrunk(double margin) const {
  Polygon shrunk = vertices_;
  for (size_t i = 0; i < vertices_.size() && !shrunk.empty(); ++i) {
    shrunk = Clip(shrunk, vertices_[i], vertices_[(i + 1) % vertices_.size()], margin);
  }
  return shrunk;
}

Vector2d SupportPolygon::Nearest(const Vector2d& preferred, double margin) const {
  if (vertices_.size() < 3) return NearestOnBoundary(vertices_, preferred);
  constexpr double kResolution = 0.001;
  while (margin > 0 && Shrunk(margin).empty()) margin -= kResolution;
  if (Margin(preferred) >= margin) return preferred;
  const Polygon shrunk = Shrunk(std::max(margin, 0.0));
  return NearestOnBoundary(shrunk, preferred);
}

}  // namespace possibility::actions
