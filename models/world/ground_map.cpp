#include "models/world/ground_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <utility>

#include "models/input/input_error.h"
#include "models/shapes/bounds_tree.h"
#include "models/world/ground_region.h"

namespace possibility::models {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Isometry3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Largest tilt of a level, rad.
constexpr double kLevelTilt = 1e-8;

/// A face of the ground in space.
struct Face {
  std::vector<Vector3d> corners;  ///< counter-clockwise from above
  Vector3d normal = Vector3d::UnitZ();
  double friction = kRobotsFriction;
  bool is_for_steps = false;

  bool is_level() const { return (normal - Vector3d::UnitZ()).norm() <= kLevelTilt; }
  double height() const { return corners.front().z(); }
};

void RequireUpward(const Face& face, const std::string& name) {
  if (std::acos(std::clamp(face.normal.z(), -1.0, 1.0)) <= GroundMap::kSteepest + 1e-9) return;
  throw InputError(
      fmt::format("obstacle '{}': is ground but no side of it faces up, expected a tilt of at most "
                  "45 degrees",
                  name));
}

/// The side of a box that faces up most.
Face TopOf(const Obstacle& box) {
  if (box.shape.type != ShapeType::kBox) {
    throw InputError(
        fmt::format("obstacle '{}': is ground but not a box, expected a box", box.name));
  }
  if (!box.X_WO.matrix().allFinite() || !box.shape.size.allFinite()) {
    throw InputError(
        fmt::format("obstacle '{}': is ground, but its place is not finite", box.name));
  }
  int axis = 2;
  for (const int other : {0, 1}) {
    const Eigen::RowVector3d up = box.X_WO.linear().row(2);
    if (std::abs(up[other]) > std::abs(up[axis]) + 1e-9) axis = other;
  }
  const double side = box.X_WO(2, axis) < 0 ? -1 : 1;
  const int a = (axis + 1) % 3;
  const int b = (axis + 2) % 3;
  Face face;
  face.friction = box.friction;
  face.is_for_steps = box.is_for_steps;
  face.normal = side * box.X_WO.linear().col(axis);
  RequireUpward(face, box.name);
  for (const auto& [u, v] :
       {std::pair(-1, -1), std::pair(1, -1), std::pair(1, 1), std::pair(-1, 1)}) {
    Vector3d corner = Vector3d::Zero();
    corner[axis] = side * box.shape.size[axis] / 2;
    corner[a] = u * box.shape.size[a] / 2;
    corner[b] = side * v * box.shape.size[b] / 2;
    face.corners.push_back(box.X_WO * corner);
  }
  if (face.is_level()) {
    const double height = box.X_WO.translation().z() + box.shape.size[axis] / 2;
    for (Vector3d& corner : face.corners) corner.z() = height;
  }
  return face;
}

/// Twice the vector area (Newell).
Vector3d Newell(const std::vector<Vector3d>& corners) {
  Vector3d sum = Vector3d::Zero();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    sum +=
        (corners[i] - corners.front()).cross(corners[(i + 1) % corners.size()] - corners.front());
  }
  return sum;
}

Face FaceOf(const GroundFace& ground) {
  Face face;
  face.corners = ground.corners;
  face.friction = ground.friction;
  const Vector3d area = Newell(face.corners);
  if (face.corners.size() < 3 || !(area.norm() > 0) || !area.allFinite()) {
    throw InputError(fmt::format("ground '{}': a face without an area", ground.name));
  }
  face.normal = area.normalized();
  RequireUpward(face, ground.name);
  for (const Vector3d& corner : face.corners) {
    if (std::abs(face.normal.dot(corner - face.corners.front())) > GroundMap::kAbutting) {
      throw InputError(
          fmt::format("ground '{}': a face whose corners are not in one plane", ground.name));
    }
  }
  return face;
}

/// A frame of the plane, z upward. Of a level: the world's, raised.
Isometry3d FrameOf(const Face& face) {
  Isometry3d X_WG = Isometry3d::Identity();
  if (face.is_level()) {
    X_WG.translation().z() = face.height();
    return X_WG;
  }
  const Vector3d& z = face.normal;
  const Vector3d x = Vector3d(z.z(), 0, -z.x()).normalized();
  X_WG.linear() << x, z.cross(x), z;
  X_WG.translation() = face.corners.front();
  return X_WG;
}

/// All coplanar faces of one friction.
class Plane {
 public:
  explicit Plane(const std::vector<Face>& faces)
      : X_WG_(FrameOf(faces.front())), region_(Flattened(faces)) {
    is_level_ = faces.front().is_level();
    plane_.normal = X_WG_.linear().col(2);
    plane_.offset = is_level_ ? faces.front().height() : plane_.normal.dot(X_WG_.translation());
    plane_.friction = faces.front().friction;
    for (const Face& face : faces) {
      plane_.friction = std::min(plane_.friction, face.friction);
      for (const Vector3d& corner : face.corners) bounds_.extend(corner);
    }
  }

  const GroundPlane& plane() const { return plane_; }
  const GroundRegion& region() const { return region_; }
  const AlignedBox3d& bounds() const { return bounds_; }

  double HeightAt(const Vector2d& p) const {
    return is_level_ ? plane_.offset : plane_.HeightAt(p);
  }

  Vector2d InPlane(const Vector2d& p) const {
    if (is_level_) return p;
    return InPlane(Vector3d(p.x(), p.y(), plane_.HeightAt(p)));
  }

  bool IsNear(const Vector3d& p, double distance) const {
    const double above = plane_.normal.dot(p) - plane_.offset;
    if (!(std::abs(above) <= distance)) return false;
    return region_.IsNear(InPlane(p), std::sqrt(distance * distance - above * above));
  }

 private:
  Vector2d InPlane(const Vector3d& p) const {
    return X_WG_.linear().leftCols<2>().transpose() * (p - X_WG_.translation());
  }

  std::vector<std::vector<Vector2d>> Flattened(const std::vector<Face>& faces) const {
    std::vector<std::vector<Vector2d>> flat;
    for (const Face& face : faces) {
      flat.emplace_back();
      for (const Vector3d& corner : face.corners) flat.back().push_back(InPlane(corner));
    }
    return flat;
  }

  Isometry3d X_WG_;
  bool is_level_ = false;
  GroundPlane plane_;
  GroundRegion region_;
  AlignedBox3d bounds_;
};

std::vector<Face> FacesOf(const Environment& environment) {
  std::vector<Face> faces;
  for (const Obstacle& obstacle : environment.obstacles) {
    if (obstacle.is_ground && obstacle.surface < 0 &&
        obstacle.shape.type != ShapeType::kConvexMesh) {
      faces.push_back(TopOf(obstacle));
    }
  }
  for (const GroundFace& face : environment.faces) faces.push_back(FaceOf(face));
  return faces;
}

/// Level faces by height, ascending.
std::vector<std::vector<Face>> LevelsOf(std::vector<Face> faces) {
  std::stable_sort(faces.begin(), faces.end(),
                   [](const Face& a, const Face& b) { return a.height() < b.height(); });
  std::vector<std::vector<Face>> levels;
  for (Face& face : faces) {
    const bool is_next =
        levels.empty() || face.height() - levels.back().front().height() > GroundMap::kAbutting;
    if (is_next) levels.emplace_back();
    levels.back().push_back(std::move(face));
  }
  return levels;
}

bool LiesIn(const Face& face, const Face& first) {
  return std::all_of(face.corners.begin(), face.corners.end(), [&](const Vector3d& corner) {
    return std::abs(first.normal.dot(corner - first.corners.front())) <= GroundMap::kAbutting;
  });
}

/// Rough ground by plane and friction. Only planes with about the same normal are compared, because
/// uneven terrain has as many planes as faces. Neighbours in the list are often coplanar, so the
/// search begins with the last plane.
std::vector<std::vector<Face>> RoughGroundOf(std::vector<Face> faces) {
  constexpr double kCell = 1e-3;  // of the normal
  std::vector<std::vector<Face>> planes;
  std::map<std::pair<std::int64_t, std::int64_t>, std::vector<std::size_t>> by_normal;
  const auto is_plane_of = [&planes](std::size_t plane, const Face& face) {
    return face.friction == planes[plane].front().friction && LiesIn(face, planes[plane].front()) &&
           LiesIn(planes[plane].front(), face);
  };
  const auto find = [&](const Face& face, std::int64_t x, std::int64_t y) {
    if (!planes.empty() && is_plane_of(planes.size() - 1, face)) return planes.size() - 1;
    for (const std::int64_t dx : {0, -1, 1}) {
      for (const std::int64_t dy : {0, -1, 1}) {
        const auto cell = by_normal.find({x + dx, y + dy});
        if (cell == by_normal.end()) continue;
        for (const std::size_t plane : cell->second) {
          if (is_plane_of(plane, face)) return plane;
        }
      }
    }
    return planes.size();
  };
  for (Face& face : faces) {
    const std::int64_t x = std::llround(face.normal.x() / kCell);
    const std::int64_t y = std::llround(face.normal.y() / kCell);
    const std::size_t plane = find(face, x, y);
    if (plane == planes.size()) {
      planes.emplace_back();
      by_normal[{x, y}].push_back(plane);
    }
    planes[plane].push_back(std::move(face));
  }
  return planes;
}

}  // namespace

struct GroundMap::Impl {
  std::vector<double> heights;
  std::vector<Plane> planes;  ///< the levels first
  std::vector<GroundPlane> equations;
  BoundsTree rough;  ///< the planes that are no levels
  AlignedBox3d bounds;

  void Add(const std::vector<Face>& faces) {
    planes.emplace_back(faces);
    equations.push_back(planes.back().plane());
    bounds.extend(planes.back().bounds());
  }

  void PlantRoughGround() {
    std::vector<AlignedBox3d> boxes;
    for (std::size_t i = heights.size(); i < planes.size(); ++i) {
      const Vector3d rounding = Vector3d::Constant(kAbutting);
      boxes.emplace_back(planes[i].bounds().min() - rounding, planes[i].bounds().max() + rounding);
    }
    rough = BoundsTree(std::move(boxes));
  }

  /// The highest level in [low, high] with ground at p.
  std::optional<int> Highest(const Vector2d& p, double low, double high) const {
    for (int level = static_cast<int>(heights.size()) - 1; level >= 0; --level) {
      const bool in_range = heights[level] >= low && heights[level] <= high;
      if (in_range && planes[level].region().Holds(p)) return level;
    }
    return std::nullopt;
  }

  /// Calls `visit` with the planes of rough ground that have ground at p within [low, high].
  template <typename Visit>
  void VisitRough(const Vector2d& p, double low, double high, const Visit& visit) const {
    if (!p.allFinite() || !(low <= high)) return;
    const AlignedBox3d column(Vector3d(p.x(), p.y(), std::max(low, bounds.min().z() - 1)),
                              Vector3d(p.x(), p.y(), std::min(high, bounds.max().z() + 1)));
    rough.VisitNear(column, 0, [&](int index) {
      const int plane = static_cast<int>(heights.size()) + index;
      const double height = planes[plane].HeightAt(p);
      if (height >= low && height <= high &&
          planes[plane].region().Holds(planes[plane].InPlane(p))) {
        visit(plane, height);
      }
      return 0.0;
    });
  }
};

GroundMap::GroundMap(const Environment& environment, double friction)
    : impl_(std::make_unique<Impl>()) {
  std::vector<Face> level, rough;
  for (Face& face : FacesOf(environment)) {
    const bool is_of_level = face.is_level() && !face.is_for_steps && face.friction >= friction;
    (is_of_level ? level : rough).push_back(std::move(face));
  }
  for (const std::vector<Face>& faces : LevelsOf(std::move(level))) {
    impl_->heights.push_back(faces.front().height());
    impl_->Add(faces);
  }
  for (const std::vector<Face>& faces : RoughGroundOf(std::move(rough))) impl_->Add(faces);
  impl_->PlantRoughGround();
}

GroundMap::~GroundMap() = default;
GroundMap::GroundMap(GroundMap&&) noexcept = default;
GroundMap& GroundMap::operator=(GroundMap&&) noexcept = default;

const std::vector<double>& GroundMap::levels() const { return impl_->heights; }
const std::vector<GroundPlane>& GroundMap::planes() const { return impl_->equations; }
AlignedBox3d GroundMap::bounds() const { return impl_->bounds; }

double GroundMap::Clearance(int plane, const Vector2d& p) const {
  const Plane& ground = impl_->planes.at(plane);
  return ground.region().Clearance(ground.InPlane(p));
}

bool GroundMap::OneFaceHolds(int plane, const Vector2d& from, const Vector2d& to,
                             double radius) const {
  const Plane& ground = impl_->planes.at(plane);
  return ground.region().OneFaceHolds(ground.InPlane(from), ground.InPlane(to), radius);
}

bool GroundMap::IsNear(int plane, const Vector2d& p, double distance) const {
  const Plane& ground = impl_->planes.at(plane);
  return ground.region().IsNear(ground.InPlane(p), distance);
}

bool GroundMap::RoughGroundIsNear(const Vector3d& p, double distance) const {
  if (impl_->planes.size() == impl_->heights.size() || !p.allFinite()) return false;
  bool found = false;
  impl_->rough.VisitNear(AlignedBox3d(p, p), distance, [&](int index) {
    found = impl_->planes[impl_->heights.size() + index].IsNear(p, distance);
    return found ? -1.0 : distance;
  });
  return found;
}

std::vector<int> GroundMap::PlanesNear(const Vector3d& p, double distance) const {
  std::vector<int> near;
  if (!p.allFinite()) return near;
  for (int level = 0; level < static_cast<int>(impl_->heights.size()); ++level) {
    if (std::abs(impl_->heights[level] - p.z()) <= distance) near.push_back(level);
  }
  const std::size_t levels = near.size();
  impl_->rough.VisitNear(AlignedBox3d(p, p), distance, [&](int index) {
    near.push_back(static_cast<int>(impl_->heights.size()) + index);
    return distance;
  });
  std::sort(near.begin() + static_cast<std::ptrdiff_t>(levels), near.end());
  return near;
}

std::optional<int> GroundMap::LevelAt(const Vector2d& p, double z, double tolerance) const {
  return impl_->Highest(p, z - tolerance, z + tolerance);
}

std::optional<int> GroundMap::LevelBelow(const Vector2d& p, double z) const {
  constexpr double kAbove = 1e-3;
  return impl_->Highest(p, -kInfinity, z + kAbove);
}

std::vector<int> GroundMap::PlanesAt(const Vector2d& p, double low, double high) const {
  std::vector<int> found;
  for (int level = 0; level < static_cast<int>(impl_->heights.size()); ++level) {
    const bool in_range = impl_->heights[level] >= low && impl_->heights[level] <= high;
    if (in_range && impl_->planes[level].region().Holds(p)) found.push_back(level);
  }
  impl_->VisitRough(p, low, high, [&](int plane, double) { found.push_back(plane); });
  std::sort(found.begin(), found.end());
  return found;
}

std::optional<double> GroundMap::HeightBelow(const Vector2d& p, double z) const {
  constexpr double kAbove = 1e-3;
  std::optional<double> highest;
  if (const auto level = LevelBelow(p, z)) highest = impl_->heights[*level];
  impl_->VisitRough(p, highest.value_or(-kInfinity), z + kAbove, [&](int, double height) {
    if (!highest || height > *highest) highest = height;
  });
  return highest;
}

}  // namespace possibility::models
