#include "experiments/exports/hull_triangles.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace possibility::experiments {
namespace {

using Eigen::Vector3d;

constexpr double kFlat = 1e-9;        // relative to the extent
constexpr double kSameNormal = 1e-6;  // rad

double ExtentOf(const std::vector<Vector3d>& points) {
  Eigen::AlignedBox3d box;
  for (const Vector3d& point : points) box.extend(point);
  return points.empty() ? 0 : box.diagonal().norm();
}

/// The points of a face around its normal, counter-clockwise from outside, without those that lie
/// inside it or on its edges.
std::vector<int> FaceOutline(const std::vector<Vector3d>& points, std::vector<int> face,
                             const Vector3d& normal, double flat) {
  // Gift wrapping: the next corner has all other points on its left.
  const auto lowest = std::min_element(face.begin(), face.end(), [&](int a, int b) {
    return std::lexicographical_compare(points[a].begin(), points[a].end(), points[b].begin(),
                                        points[b].end());
  });
  std::vector<int> outline = {*lowest};
  while (outline.size() <= face.size()) {
    const Vector3d& here = points[outline.back()];
    int next = -1;
    for (const int candidate : face) {
      const Vector3d step = points[candidate] - here;
      if (step.norm() <= flat) continue;
      if (next < 0) {
        next = candidate;
        continue;
      }
      const Vector3d best = points[next] - here;
      const double turn = normal.dot(best.cross(step));
      const double level = flat * std::max(best.norm(), step.norm());
      if (turn < -level || (turn <= level && step.norm() > best.norm())) next = candidate;
    }
    if (next < 0 || next == outline.front()) break;
    outline.push_back(next);
  }
  return outline;
}

/// The points in the plane through three of them, if all others lie on the inner side of it; empty
/// otherwise. `normal`: of the plane, outward.
std::vector<int> FacePoints(const std::vector<Vector3d>& points, const Vector3d& in_plane,
                            const Vector3d& normal, double flat) {
  std::vector<int> face;
  bool has_depth = false;
  for (int k = 0; k < static_cast<int>(points.size()); ++k) {
    const double height = normal.dot(points[k] - in_plane);
    if (height > flat) return {};
    has_depth = has_depth || height < -flat;
    if (height >= -flat) face.push_back(k);
  }
  return has_depth ? face : std::vector<int>();
}

/// Finds the faces of a hull one after the other, each once.
class HullFaces {
 public:
  explicit HullFaces(const std::vector<Vector3d>& points)
      : points_(points), flat_(kFlat * ExtentOf(points)) {}

  /// Takes the face through three points, if there is one, with its outward side along the normal
  /// of a, b, c.
  void Try(int a, int b, int c) {
    const Vector3d cross =
        Vector3d(points_[b] - points_[a]).cross(Vector3d(points_[c] - points_[a]));
    if (cross.norm() <= flat_ * flat_) return;
    const Vector3d normal = cross.normalized();
    for (const Vector3d& known : normals_) {
      if ((known - normal).norm() < kSameNormal) return;
    }
    const std::vector<int> face = FacePoints(points_, points_[a], normal, flat_);
    if (face.empty()) return;
    normals_.push_back(normal);
    const std::vector<int> outline = FaceOutline(points_, face, normal, flat_);
    for (std::size_t k = 2; k < outline.size(); ++k) {
      triangles_.push_back({outline[0], outline[k - 1], outline[k]});
    }
  }

  const std::vector<std::array<int, 3>>& triangles() const { return triangles_; }

 private:
  const std::vector<Vector3d>& points_;
  double flat_;
  std::vector<Vector3d> normals_;
  std::vector<std::array<int, 3>> triangles_;
};

}  // namespace

std::vector<std::array<int, 3>> HullTriangles(const std::vector<Vector3d>& points) {
  const int n = static_cast<int>(points.size());
  HullFaces faces(points);
  for (int a = 0; a < n; ++a) {
    for (int b = a + 1; b < n; ++b) {
      for (int c = b + 1; c < n; ++c) {
        faces.Try(a, b, c);
        faces.Try(a, c, b);
      }
    }
  }
  return faces.triangles();
}

}  // namespace possibility::experiments
