#include "models/mesh/flat_regions.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <unordered_map>

#include "models/mesh/convex_merge.h"

namespace possibility::models {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// A region whose corners this horizontal slab holds is horizontal, m.
constexpr double kLevel = 1e-5;

/// Fits of a region's last plane, each of which may give triangles back.
constexpr int kRounds = 4;

struct Plane {
  Vector3d normal = Vector3d::UnitZ();
  double offset = 0;  ///< normal . p on the plane

  double Above(const Vector3d& p) const { return normal.dot(p) - offset; }
};

/// Sums over points with weights, about the first of them so that places far from the origin lose
/// no digits.
class Moments {
 public:
  void Add(double weight, const Vector3d& p) {
    if (weight_ == 0) origin_ = p;
    const Vector3d r = p - origin_;
    weight_ += weight;
    first_ += weight * r;
    second_ += weight * r * r.transpose();
  }

  /// The plane of least squares, with its normal on the side of `seed`'s; `seed` if the points
  /// leave it open.
  Plane Fitted(const Plane& seed) const {
    const Vector3d mean = first_ / weight_;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(second_ / weight_ -
                                                                mean * mean.transpose());
    Vector3d normal = solver.eigenvectors().col(0);
    if (solver.info() != Eigen::Success || !normal.allFinite()) return seed;
    if (normal.dot(seed.normal) < 0) normal = -normal;
    return {normal, normal.dot(origin_ + mean)};
  }

 private:
  double weight_ = 0;
  Vector3d origin_ = Vector3d::Zero();
  Vector3d first_ = Vector3d::Zero();
  Eigen::Matrix3d second_ = Eigen::Matrix3d::Zero();
};

/// Triangles beside each other.
std::vector<std::vector<int>> NeighboursOf(const TriangleMesh& mesh) {
  std::vector<std::tuple<int, int, int>> sides;
  sides.reserve(3 * mesh.triangles.size());
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
    for (int i = 0; i < 3; ++i) {
      const auto [low, high] = std::minmax(mesh.triangles[t][i], mesh.triangles[t][(i + 1) % 3]);
      sides.emplace_back(low, high, t);
    }
  }
  std::sort(sides.begin(), sides.end());
  std::vector<std::vector<int>> neighbours(mesh.triangles.size());
  for (std::size_t i = 1; i < sides.size(); ++i) {
    const auto& [low, high, t] = sides[i - 1];
    const auto& [next_low, next_high, next_t] = sides[i];
    if (low != next_low || high != next_high) continue;
    neighbours[t].push_back(next_t);
    neighbours[next_t].push_back(t);
  }
  return neighbours;
}

class Grower {
 public:
  explicit Grower(const TriangleMesh& mesh)
      : mesh_(mesh), neighbours_(NeighboursOf(mesh)), taken_(mesh.triangles.size(), false) {
    for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
      const Vector3d area = mesh.AreaVector(t);
      areas_.push_back(area.norm() / 2);
      normals_.push_back(area.normalized());
    }
  }

  std::vector<FlatRegion> Regions() {
    std::vector<int> order(mesh_.triangles.size());
    for (std::size_t t = 0; t < order.size(); ++t) order[t] = static_cast<int>(t);
    std::stable_sort(order.begin(), order.end(),
                     [&](int a, int b) { return areas_[a] > areas_[b]; });
    std::vector<FlatRegion> regions;
    for (const int seed : order) {
      if (!taken_[seed]) regions.push_back(GrownFrom(seed));
    }
    return regions;
  }

 private:
  const Vector3d& Corner(int triangle, int i) const {
    return mesh_.vertices[mesh_.triangles[triangle][i]];
  }

  Plane PlaneOf(int triangle) const {
    return {normals_[triangle], normals_[triangle].dot(Corner(triangle, 0))};
  }

  /// Whether a triangle is too thin for its direction to matter.
  bool IsThin(int t) const {
    double longest = 0;
    for (int i = 0; i < 3; ++i) {
      longest = std::max(longest, (Corner(t, (i + 1) % 3) - Corner(t, i)).norm());
    }
    return 2 * areas_[t] < kFlatness * longest;
  }

  bool Fits(int t, const Plane& plane, double tolerance) const {
    for (int i = 0; i < 3; ++i) {
      if (!(std::abs(plane.Above(Corner(t, i))) <= tolerance)) return false;
    }
    return normals_[t].dot(plane.normal) >= std::cos(kMostTurned) || IsThin(t);
  }

  /// The plane follows the region as it grows: that of one triangle says little of a wide, slightly
  /// uneven floor. Triangles that do not fit the last plane are given back.
  FlatRegion GrownFrom(int seed) {
    Moments moments;
    Plane plane = PlaneOf(seed);
    std::vector<int> region = {seed};
    taken_[seed] = true;
    Add(seed, &moments);
    std::size_t fitted = 1;
    for (std::size_t before = 0; before < region.size();) {
      before = region.size();
      // Once more from the beginning: what did not fit the first planes may fit the later ones.
      for (std::size_t i = 0; i < region.size(); ++i) {
        for (const int next : neighbours_[region[i]]) {
          if (taken_[next] || !Fits(next, plane, kFlatness / 2)) continue;
          taken_[next] = true;
          region.push_back(next);
          Add(next, &moments);
          if (region.size() < 2 * fitted) continue;
          fitted = region.size();
          plane = moments.Fitted(PlaneOf(seed));
        }
      }
      if (fitted == 1) break;
    }
    for (int round = 0; round < kRounds; ++round) {
      plane = FittedPlane(region, seed);
      std::vector<int> kept;
      for (const int t : region) {
        if (t == seed || Fits(t, plane, kFlatness)) {
          kept.push_back(t);
        } else {
          taken_[t] = false;
        }
      }
      const bool is_done = kept.size() == region.size();
      region = std::move(kept);
      if (is_done && Fits(seed, plane, kFlatness)) return RegionOf(region, plane);
    }
    for (const int t : region) taken_[t] = t == seed;
    return RegionOf({seed}, PlaneOf(seed));
  }

  void Add(int t, Moments* moments) const {
    for (int i = 0; i < 3; ++i) moments->Add(areas_[t] / 3, Corner(t, i));
  }

  /// The horizontal plane if it holds the region; otherwise that of least squares.
  Plane FittedPlane(const std::vector<int>& region, int seed) const {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    Moments moments;
    for (const int t : region) {
      Add(t, &moments);
      for (int i = 0; i < 3; ++i) {
        low = std::min(low, Corner(t, i).z());
        high = std::max(high, Corner(t, i).z());
      }
    }
    if (high - low <= kLevel && std::abs(normals_[seed].z()) >= std::cos(kMostTurned)) {
      const double sign = std::copysign(1.0, normals_[seed].z());
      return {sign * Vector3d::UnitZ(), sign * (low + high) / 2};
    }
    return moments.Fitted(PlaneOf(seed));
  }

  FlatRegion RegionOf(const std::vector<int>& triangles, const Plane& plane) const {
    FlatRegion region;
    region.normal = plane.normal;
    region.triangles = triangles;
    for (const int t : triangles) region.area += areas_[t];
    // Seen along z if the plane is level enough, otherwise along its normal: two axes of that view,
    // and how a point of the view returns to the plane.
    const bool along_z = std::abs(plane.normal.z()) >= std::cos(kSteepestBearing);
    const Vector3d view =
        along_z ? Vector3d(std::copysign(1.0, plane.normal.z()) * Vector3d::UnitZ()) : plane.normal;
    const Vector3d x = view.unitOrthogonal();
    const Vector3d y = view.cross(x);
    std::unordered_map<int, int> index;
    std::vector<Vector2d> points;
    std::vector<std::array<int, 3>> flat;
    for (const int t : triangles) {
      std::array<int, 3> corners;
      for (int i = 0; i < 3; ++i) {
        const auto [known, is_new] =
            index.try_emplace(mesh_.triangles[t][i], static_cast<int>(points.size()));
        if (is_new) points.emplace_back(x.dot(Corner(t, i)), y.dot(Corner(t, i)));
        corners[i] = known->second;
      }
      flat.push_back(corners);
    }
    for (const ConvexPolygon& polygon : MergedConvex(points, flat)) {
      if (polygon.size() < 3 || !(AreaOf(polygon) > 0)) continue;
      std::vector<Vector3d>& corners = region.polygons.emplace_back();
      for (const Vector2d& p : polygon) {
        const Vector3d in_view = p.x() * x + p.y() * y;
        corners.push_back(in_view - plane.Above(in_view) / plane.normal.dot(view) * view);
      }
    }
    return region;
  }

  const TriangleMesh& mesh_;
  std::vector<std::vector<int>> neighbours_;
  std::vector<bool> taken_;
  std::vector<double> areas_;
  std::vector<Vector3d> normals_;
};

}  // namespace

bool FlatRegion::IsLevelEnough() const {
  // A slope of exactly 45 degrees bears, whatever the rounding.
  return normal.z() >= std::cos(kSteepestBearing) - 1e-10;
}

std::vector<FlatRegion> FlatRegions(const TriangleMesh& mesh) { return Grower(mesh).Regions(); }

}  // namespace possibility::models
