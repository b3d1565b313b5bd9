#include "models/mesh/convex_merge.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

namespace possibility::models {
namespace {

using Eigen::Vector2d;

double Cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

/// How far c lies to the right of the line from a to b, m.
double RightOf(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  const double length = (b - a).norm();
  return length > 0 ? -Cross(b - a, c - a) / length : -(c - a).norm();
}

/// Depth of a point of the polygon below its nearest side.
double DepthIn(const ConvexPolygon& polygon, const Vector2d& p) {
  double depth = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    depth = std::min(depth, -RightOf(polygon[i], polygon[(i + 1) % polygon.size()], p));
  }
  return depth;
}

double PerimeterOf(const ConvexPolygon& polygon) {
  double perimeter = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    perimeter += (polygon[(i + 1) % polygon.size()] - polygon[i]).norm();
  }
  return perimeter;
}

/// A corner on a side does no harm; this much below it, it is left out.
constexpr double kOnSide = 1e-9;  // m

/// In the end so are corners that single precision moved off a side.
constexpr double kRounding = 2e-7;  // m

class Merger {
 public:
  Merger(const std::vector<Vector2d>& points, const std::vector<std::array<int, 3>>& triangles)
      : group_(triangles.size()), parts_(triangles.size()) {
    std::iota(group_.begin(), group_.end(), 0);
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      Part& part = parts_[t];
      for (const int corner : triangles[t]) part.corners.push_back(points[corner]);
      part.area = AreaOf(part.corners);
    }
    Connect(points, triangles);
  }

  std::vector<ConvexPolygon> Merged() {
    // Pairs that share the longest side of both: the halves of quadrilaterals.
    for (int t = 0; t < static_cast<int>(parts_.size()); ++t) {
      if (group_[t] != t || parts_[t].neighbours.empty()) continue;
      const int other = halves_[t];
      if (other > t && halves_[other] == t) TryToMerge(t, other);
    }
    while (Pass()) {
    }
    std::vector<ConvexPolygon> polygons;
    for (int t = 0; t < static_cast<int>(parts_.size()); ++t) {
      if (group_[t] == t) polygons.push_back(HullOf(std::move(parts_[t].corners), kRounding));
    }
    return polygons;
  }

 private:
  struct Part {
    ConvexPolygon corners;
    double area = 0;              ///< of its triangles
    std::vector<int> neighbours;  ///< triangles beside it, or merged into it since
  };

  void Connect(const std::vector<Vector2d>& points,
               const std::vector<std::array<int, 3>>& triangles) {
    struct Side {
      int low, high, triangle;
      double length;
    };
    std::vector<Side> sides;
    std::vector<double> longest(triangles.size(), 0);
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      for (int i = 0; i < 3; ++i) {
        const auto [low, high] = std::minmax(triangles[t][i], triangles[t][(i + 1) % 3]);
        const double length = (points[high] - points[low]).norm();
        sides.push_back({low, high, static_cast<int>(t), length});
        longest[t] = std::max(longest[t], length);
      }
    }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
      return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
    });
    halves_.assign(triangles.size(), -1);
    for (std::size_t i = 1; i < sides.size(); ++i) {
      const Side& a = sides[i - 1];
      const Side& b = sides[i];
      if (a.low != b.low || a.high != b.high) continue;
      parts_[a.triangle].neighbours.push_back(b.triangle);
      parts_[b.triangle].neighbours.push_back(a.triangle);
      if (a.length >= longest[a.triangle]) halves_[a.triangle] = b.triangle;
      if (b.length >= longest[b.triangle]) halves_[b.triangle] = a.triangle;
    }
  }

  int GroupOf(int triangle) {
    while (group_[triangle] != triangle) {
      group_[triangle] = group_[group_[triangle]];
      triangle = group_[triangle];
    }
    return triangle;
  }

  bool TryToMerge(int a, int b) {
    Part& A = parts_[a];
    Part& B = parts_[b];
    std::vector<Vector2d> corners = A.corners;
    corners.insert(corners.end(), B.corners.begin(), B.corners.end());
    const ConvexPolygon hull = HullOf(corners, kOnSide);
    if (hull.size() < 3) return false;
    const double area = A.area + B.area;
    if (AreaOf(hull) - area > kConvexSlack * PerimeterOf(hull)) return false;
    for (const Vector2d& corner : corners) {
      if (DepthIn(hull, corner) > kConvexSlack) return false;
    }
    A.corners = hull;
    A.area = area;
    A.neighbours.insert(A.neighbours.end(), B.neighbours.begin(), B.neighbours.end());
    B = Part();
    group_[b] = a;
    return true;
  }

  /// Lets every part grow once; false if none did.
  bool Pass() {
    bool has_changed = false;
    for (int t = 0; t < static_cast<int>(parts_.size()); ++t) {
      if (group_[t] != t) continue;
      for (std::size_t i = 0; i < parts_[t].neighbours.size(); ++i) {
        const int other = GroupOf(parts_[t].neighbours[i]);
        if (other != t && TryToMerge(t, other)) has_changed = true;
      }
      ForgetOwn(t);
    }
    return has_changed;
  }

  /// Neighbours that are the part itself by now, and repetitions.
  void ForgetOwn(int t) {
    std::vector<int>& neighbours = parts_[t].neighbours;
    for (int& neighbour : neighbours) neighbour = GroupOf(neighbour);
    std::sort(neighbours.begin(), neighbours.end());
    neighbours.erase(std::unique(neighbours.begin(), neighbours.end()), neighbours.end());
    neighbours.erase(std::remove(neighbours.begin(), neighbours.end(), t), neighbours.end());
  }

  std::vector<int> group_;  ///< a step towards the part that a triangle belongs to
  std::vector<Part> parts_;
  std::vector<int> halves_;  ///< the triangle beyond the longest side, or -1
};

}  // namespace

double AreaOf(const ConvexPolygon& polygon) {
  double twice = 0;
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    twice += Cross(polygon[i] - polygon[0], polygon[i + 1] - polygon[0]);
  }
  return twice / 2;
}

ConvexPolygon HullOf(std::vector<Vector2d> points, double slack) {
  std::sort(points.begin(), points.end(), [](const Vector2d& a, const Vector2d& b) {
    return std::make_pair(a.x(), a.y()) < std::make_pair(b.x(), b.y());
  });
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  // The lower chain from left to right, then the upper one back.
  ConvexPolygon hull;
  const auto add = [&hull, slack](const Vector2d& p, std::size_t begin) {
    while (hull.size() >= begin + 2 && RightOf(hull[hull.size() - 2], p, hull.back()) <= slack) {
      hull.pop_back();
    }
    hull.push_back(p);
  };
  for (const Vector2d& p : points) add(p, 0);
  const std::size_t lower = hull.size() - 1;
  for (auto p = points.rbegin() + 1; p != points.rend(); ++p) add(*p, lower);
  hull.pop_back();
  return hull;
}

std::vector<ConvexPolygon> MergedConvex(const std::vector<Vector2d>& points,
                                        const std::vector<std::array<int, 3>>& triangles) {
  return Merger(points, triangles).Merged();
}

}  // namespace possibility::models
