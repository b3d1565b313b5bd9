#include "models/world/terrain.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "models/mesh/flat_regions.h"
#include "models/world/ground_map.h"

namespace possibility::models {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Polygon = std::vector<Vector3d>;

/// Narrower pieces are left out: nothing fits between their neighbours, m.
constexpr double kNarrow = 1e-6;

/// A polygon whose corners are this near to a rectangle's is one, m.
constexpr double kSquare = 1e-7;

/// A corner this near to the top of a region is at its top, m.
constexpr double kAtTop = 1e-3;

static_assert(kSteepestBearing == GroundMap::kSteepest);

Eigen::Matrix3d FrameAlongLongestSide(const Polygon& polygon, const Vector3d& normal) {
  Vector3d longest = Vector3d::Zero();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector3d side = polygon[(i + 1) % polygon.size()] - polygon[i];
    if (side.squaredNorm() > longest.squaredNorm()) longest = side;
  }
  Eigen::Matrix3d R;
  R.col(2) = normal;
  R.col(0) = (longest - longest.dot(normal) * normal).normalized();
  R.col(1) = R.col(2).cross(R.col(0));
  return R;
}

bool IsRectangle(const Polygon& corners, const Eigen::AlignedBox3d& bounds) {
  return corners.size() == 4 &&
         std::all_of(corners.begin(), corners.end(), [&](const Vector3d& corner) {
           return (corner - bounds.min()).cwiseMin(bounds.max() - corner).head<2>().maxCoeff() <=
                  kSquare;
         });
}

/// The solid below a polygon, or nothing if that is too narrow. Its z axis is the outward normal,
/// so that distances above the polygon are found at once.
std::optional<Obstacle> SolidBelow(const Polygon& polygon, const Vector3d& normal,
                                   const std::optional<double>& base) {
  Obstacle solid;
  const Eigen::Matrix3d R = FrameAlongLongestSide(polygon, normal);
  Polygon top;
  Eigen::AlignedBox3d bounds;
  for (const Vector3d& corner : polygon) {
    top.push_back(R.transpose() * corner);
    bounds.extend(top.back());
  }
  if (!(bounds.sizes().head<2>().minCoeff() > kNarrow)) return std::nullopt;
  Vector3d centre = bounds.center();
  const bool is_upright = !base || normal == Vector3d::UnitZ();
  if (is_upright && IsRectangle(top, bounds)) {
    const double depth = base ? polygon[0].z() - *base : kSheet;
    solid.shape = Shape::Box({bounds.sizes().x(), bounds.sizes().y(), depth});
    centre.z() -= depth / 2;
  } else {
    std::vector<Vector3d> vertices;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vector3d bottom = base ? Vector3d(polygon[i].x(), polygon[i].y(), *base)
                                   : Vector3d(polygon[i] - kSheet * normal);
      vertices.push_back(top[i] - centre);
      vertices.push_back(R.transpose() * bottom - centre);
    }
    solid.shape = Shape::ConvexMesh(std::move(vertices));
  }
  solid.X_WO.linear() = R;
  solid.X_WO.translation() = R * centre;
  return solid;
}

/// Headings, modulo a right angle, of the sides of ground faces: each with a good part of the
/// length of all sides.
class MainHeadings {
 public:
  void Add(const Polygon& polygon) {
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vector2d side = (polygon[(i + 1) % polygon.size()] - polygon[i]).head<2>();
      const double turned = 4 * std::atan2(side.y(), side.x());
      const double part = turned / (2 * std::numbers::pi) + 3;  // at least 1
      const auto bin = static_cast<std::size_t>(part * kBins) % kBins;
      sums_[bin] += side.norm() * Vector2d(std::cos(turned), std::sin(turned));
      length_ += side.norm();
    }
  }

  std::vector<double> Headings() const {
    std::vector<double> headings;
    for (std::size_t bin = 0; bin < kBins; ++bin) {
      // Sides along a bin's limit are in two bins.
      const Vector2d sum = sums_[bin] + sums_[(bin + 1) % kBins];
      const double own = sum.norm();
      const bool is_peak = own >= Pair(bin + kBins - 1) && own > Pair(bin + 1);
      if (is_peak && own > kGoodPart * length_)
        headings.push_back(std::atan2(sum.y(), sum.x()) / 4);
    }
    return headings;
  }

 private:
  static constexpr std::size_t kBins = 90;
  static constexpr double kGoodPart = 0.15;

  double Pair(std::size_t bin) const {
    return (sums_[bin % kBins] + sums_[(bin + 1) % kBins]).norm();
  }

  std::array<Vector2d, kBins> sums_ = MakeZeros();
  double length_ = 0;

  static std::array<Vector2d, kBins> MakeZeros() {
    std::array<Vector2d, kBins> zeros;
    zeros.fill(Vector2d::Zero());
    return zeros;
  }
};

/// Whether a region's top corners are corners of something that bears.
bool DropsFrom(const FlatRegion& region, const TriangleMesh& mesh,
               const std::vector<bool>& vertex_bears) {
  double top = -std::numeric_limits<double>::infinity();
  double bearing_top = top;
  for (const int t : region.triangles) {
    for (const int vertex : mesh.triangles[t]) {
      const double z = mesh.vertices[vertex].z();
      top = std::max(top, z);
      if (vertex_bears[vertex]) bearing_top = std::max(bearing_top, z);
    }
  }
  return bearing_top >= top - kAtTop;
}

}  // namespace

void AddTerrain(const Terrain& terrain, Environment* environment) {
  const TriangleMesh& mesh = terrain.mesh;
  const std::vector<FlatRegion> regions = FlatRegions(mesh);
  const auto bears = [&](const FlatRegion& region) {
    return terrain.is_ground && region.IsLevelEnough();
  };
  std::vector<bool> vertex_bears(mesh.vertices.size(), false);
  for (const FlatRegion& region : regions) {
    if (!bears(region)) continue;
    for (const int t : region.triangles) {
      for (const int vertex : mesh.triangles[t]) vertex_bears[vertex] = true;
    }
  }
  const auto surface = static_cast<int>(environment->surfaces.size());
  MainHeadings headings;
  for (const FlatRegion& region : regions) {
    const bool is_face = bears(region) && region.area >= kLeastGround;
    const bool is_ground = bears(region) || DropsFrom(region, mesh, vertex_bears);
    for (const Polygon& polygon : region.polygons) {
      std::optional<Obstacle> solid = SolidBelow(polygon, region.normal, terrain.base);
      if (!solid) continue;
      solid->name = terrain.name;
      solid->is_ground = is_ground;
      solid->surface = surface;
      solid->friction = terrain.friction;
      environment->obstacles.push_back(*std::move(solid));
      if (!is_face) continue;
      environment->faces.push_back({terrain.name, polygon, terrain.friction});
      headings.Add(polygon);
    }
  }
  environment->surfaces.push_back({terrain.name, mesh, terrain.is_ground, headings.Headings()});
}

}  // namespace possibility::models
