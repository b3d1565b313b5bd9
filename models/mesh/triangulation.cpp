#include "models/mesh/triangulation.h"

#include <cstddef>
#include <numeric>
#include <utility>

namespace possibility::models {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Twice the area, positive if counter-clockwise.
double Turn(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  const Vector2d u = b - a, v = c - a;
  return u.x() * v.y() - u.y() * v.x();
}

/// The corners along the coordinate plane that the polygon faces most, counter-clockwise.
std::vector<Vector2d> Flattened(const std::vector<Vector3d>& corners) {
  Vector3d area = Vector3d::Zero();
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    area += (corners[i] - corners[0]).cross(corners[i + 1] - corners[0]);
  }
  int axis = 0;
  area.cwiseAbs().maxCoeff(&axis);
  const int x = (axis + 1) % 3, y = (axis + 2) % 3;
  std::vector<Vector2d> flat;
  // A mirrored view makes a clockwise polygon counter-clockwise.
  const double side = area[axis] < 0 ? -1 : 1;
  for (const Vector3d& p : corners) flat.emplace_back(side * p[x], p[y]);
  return flat;
}

/// The corners that are left, in order.
class Clipper {
 public:
  explicit Clipper(std::vector<Vector2d> points)
      : points_(std::move(points)), left_(points_.size()) {
    std::iota(left_.begin(), left_.end(), 0);
  }

  std::vector<std::array<int, 3>> Triangles() {
    std::vector<std::array<int, 3>> triangles;
    while (left_.size() >= 3) {
      const std::size_t ear = FindEar();
      triangles.push_back({left_[Before(ear)], left_[ear], left_[After(ear)]});
      left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(ear));
    }
    return triangles;
  }

 private:
  std::size_t Before(std::size_t i) const { return (i + left_.size() - 1) % left_.size(); }
  std::size_t After(std::size_t i) const { return (i + 1) % left_.size(); }
  const Vector2d& Point(std::size_t i) const { return points_[left_[i]]; }

  double TurnAt(std::size_t i) const { return Turn(Point(Before(i)), Point(i), Point(After(i))); }

  /// Whether no other corner lies in the triangle at i.
  bool IsEar(std::size_t i) const {
    const Vector2d& a = Point(Before(i));
    const Vector2d& b = Point(i);
    const Vector2d& c = Point(After(i));
    for (std::size_t j = 0; j < left_.size(); ++j) {
      const Vector2d& p = Point(j);
      if (p == a || p == b || p == c) continue;
      if (Turn(a, b, p) >= 0 && Turn(b, c, p) >= 0 && Turn(c, a, p) >= 0) return false;
    }
    return true;
  }

  /// The first ear; the sharpest left turn if there is none.
  std::size_t FindEar() const {
    std::size_t best = 0;
    for (std::size_t i = 0; i < left_.size(); ++i) {
      if (TurnAt(i) > 0 && IsEar(i)) return i;
      if (TurnAt(i) > TurnAt(best)) best = i;
    }
    return best;
  }

  std::vector<Vector2d> points_;
  std::vector<int> left_;
};

}  // namespace

std::vector<std::array<int, 3>> Triangulated(const std::vector<Vector3d>& corners) {
  if (corners.size() < 3) return {};
  if (corners.size() == 3) return {{0, 1, 2}};
  return Clipper(Flattened(corners)).Triangles();
}

}  // namespace possibility::models
