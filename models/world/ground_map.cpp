#include "models/world/ground_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "models/input/input_error.h"
#include "models/shapes/bounds_tree.h"

namespace possibility::models {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Every face grows by this on all sides, so that abutting faces overlap; distances then shrink by
/// it again. Twice this exceeds the gap allowed between abutting faces.
constexpr double kGrowth = 0.6 * GroundMap::kAbutting;

/// An edge counts as inside another face only if it lies this deep in it, m. Where edges of two
/// faces coincide, rounding must not make each cover the other.
constexpr double kCoverDepth = 1e-9;

/// Up to so many faces or sides, a tree of bounds takes longer than testing them all.
constexpr std::size_t kFew = 16;

/// Largest tilt of an upright box, rad.
constexpr double kMaxTilt = 1e-8;

/// A grown top face.
struct Face {
  Vector2d centre;
  Vector2d half_extents;
  Eigen::Matrix2d axes;  ///< columns: its x and y axes in the world

  bool Contains(const Vector2d& p) const {
    const Vector2d local = axes.transpose() * (p - centre);
    return (local.cwiseAbs().array() <= half_extents.array()).all();
  }

  /// How far p lies from the nearest side, negative outside.
  double Depth(const Vector2d& p) const {
    const Vector2d local = axes.transpose() * (p - centre);
    return (half_extents - local.cwiseAbs()).minCoeff();
  }

  std::array<Vector2d, 4> Corners() const {
    const Vector2d x = axes.col(0) * half_extents.x();
    const Vector2d y = axes.col(1) * half_extents.y();
    return {centre - x - y, centre + x - y, centre + x + y, centre - x + y};
  }
};

struct Segment {
  Vector2d from;
  Vector2d to;

  double Distance(const Vector2d& p) const {
    const Vector2d along = to - from;
    const double t = along.dot(p - from) / along.squaredNorm();
    return (p - from - std::clamp(t, 0.0, 1.0) * along).norm();
  }
};

AlignedBox3d FlatBounds(const Vector2d& p) {
  const Vector3d point(p.x(), p.y(), 0);
  return {point, point};
}

AlignedBox3d FlatBounds(const Segment& segment) {
  return FlatBounds(segment.from).merged(FlatBounds(segment.to));
}

AlignedBox3d FlatBounds(const Face& face) {
  AlignedBox3d bounds;
  for (const Vector2d& corner : face.Corners()) bounds.extend(FlatBounds(corner));
  return bounds;
}

template <typename Item>
BoundsTree FlatTree(const std::vector<Item>& items) {
  std::vector<AlignedBox3d> bounds;
  bounds.reserve(items.size());
  for (const Item& item : items) bounds.push_back(FlatBounds(item));
  return BoundsTree(std::move(bounds));
}

/// The part [first, second] of the segment (0 at `from`, 1 at `to`) that lies inside the face by
/// more than kCoverDepth; empty (first >= second) if none does.
std::pair<double, double> CoveredPart(const Segment& segment, const Face& face) {
  const Vector2d start = face.axes.transpose() * (segment.from - face.centre);
  const Vector2d along = face.axes.transpose() * (segment.to - segment.from);
  double first = 0, second = 1;
  for (int i = 0; i < 2; ++i) {
    const double extent = face.half_extents[i] - kCoverDepth;
    if (std::abs(along[i]) < kCoverDepth * 1e-3) {
      if (std::abs(start[i]) >= extent) return {1, 0};
      continue;
    }
    const double a = (-extent - start[i]) / along[i];
    const double b = (extent - start[i]) / along[i];
    first = std::max(first, std::min(a, b));
    second = std::min(second, std::max(a, b));
  }
  return {first, second};
}

/// The parts of an edge that other faces do not cover: pieces of the union's boundary.
std::vector<Segment> UncoveredParts(const Segment& edge,
                                    std::vector<std::pair<double, double>> covered) {
  std::sort(covered.begin(), covered.end());
  covered.emplace_back(1, 1);
  std::vector<Segment> parts;
  double reached = 0;
  for (const auto& [first, second] : covered) {
    if (first > reached) {
      const Vector2d along = edge.to - edge.from;
      parts.push_back({edge.from + reached * along, edge.from + first * along});
    }
    reached = std::max(reached, second);
  }
  return parts;
}

double TopHeight(const Obstacle& obstacle) {
  if (obstacle.shape.type != ShapeType::kBox) {
    throw InputError(fmt::format("obstacle '{}': is ground but not a box, expected an upright box",
                                 obstacle.name));
  }
  const double tilt = (obstacle.X_WO.linear().col(2) - Vector3d::UnitZ()).norm();
  const double height = obstacle.X_WO.translation().z() + obstacle.shape.size.z() / 2;
  if (!(tilt <= kMaxTilt) || !obstacle.X_WO.matrix().allFinite() || !std::isfinite(height)) {
    throw InputError(
        fmt::format("obstacle '{}': is ground but tilted, expected an upright box (yaw is free)",
                    obstacle.name));
  }
  return height;
}

Face TopFace(const Obstacle& obstacle) {
  return {obstacle.X_WO.translation().head<2>(),
          obstacle.shape.size.head<2>() / 2 + Vector2d::Constant(kGrowth),
          obstacle.X_WO.linear().topLeftCorner<2, 2>()};
}

/// All coplanar faces and the boundary of their union.
class Level {
 public:
  explicit Level(std::vector<Face> faces) : faces_(std::move(faces)), face_tree_(FlatTree(faces_)) {
    for (int face = 0; face < static_cast<int>(faces_.size()); ++face) AddBoundary(face);
    boundary_tree_ = FlatTree(boundary_);
  }

  /// Faces are convex, so a line is closest to their sides at one of its ends.
  bool OneFaceHolds(const Vector2d& from, const Vector2d& to, double radius) const {
    const double needed = radius + kGrowth;
    return SomeFaceAt(from, [&](const Face& face) {
      return face.Depth(from) >= needed && face.Depth(to) >= needed;
    });
  }

  double Clearance(const Vector2d& p) const {
    const double distance = DistanceToBoundary(p, kInfinity);
    return (IsInside(p) ? distance : -distance) - kGrowth;
  }

  bool IsNear(const Vector2d& p, double distance) const {
    return IsInside(p) || DistanceToBoundary(p, distance) < distance;
  }

  /// Whether the clearance is more than -kAbutting: the very edge counts as ground.
  bool Holds(const Vector2d& p) const {
    return IsInside(p) ||
           DistanceToBoundary(p, GroundMap::kAbutting) + kGrowth < GroundMap::kAbutting;
  }

 private:
  void AddBoundary(int face) {
    const std::array<Vector2d, 4> corners = faces_[face].Corners();
    for (int i = 0; i < 4; ++i) {
      const Segment edge{corners[i], corners[(i + 1) % 4]};
      std::vector<std::pair<double, double>> covered;
      face_tree_.VisitNear(FlatBounds(edge), 0, [&](int other) {
        if (other != face) {
          const std::pair<double, double> part = CoveredPart(edge, faces_[other]);
          if (part.first < part.second) covered.push_back(part);
        }
        return 0.0;
      });
      const std::vector<Segment> parts = UncoveredParts(edge, std::move(covered));
      boundary_.insert(boundary_.end(), parts.begin(), parts.end());
    }
  }

  /// Whether `test` holds for some face. A face that does not hold p fails the test.
  template <typename Test>
  bool SomeFaceAt(const Vector2d& p, const Test& test) const {
    if (faces_.size() <= kFew) return std::any_of(faces_.begin(), faces_.end(), test);
    bool found = false;
    face_tree_.VisitNear(FlatBounds(p), 0, [&](int face) {
      found = test(faces_[face]);
      return found ? -1.0 : 0.0;
    });
    return found;
  }

  bool IsInside(const Vector2d& p) const {
    return SomeFaceAt(p, [&](const Face& face) { return face.Contains(p); });
  }

  /// Distance to the boundary, at most `at_most`.
  double DistanceToBoundary(const Vector2d& p, double at_most) const {
    double nearest = at_most;
    if (boundary_.size() <= kFew) {
      for (const Segment& segment : boundary_) nearest = std::min(nearest, segment.Distance(p));
      return nearest;
    }
    boundary_tree_.VisitNear(FlatBounds(p), nearest, [&](int segment) {
      nearest = std::min(nearest, boundary_[segment].Distance(p));
      return nearest;
    });
    return nearest;
  }

  std::vector<Face> faces_;
  BoundsTree face_tree_;
  std::vector<Segment> boundary_;
  BoundsTree boundary_tree_;
};

}  // namespace

struct GroundMap::Impl {
  std::vector<double> heights;
  std::vector<Level> levels;

  /// The highest level in [low, high] with ground at p.
  std::optional<int> Highest(const Vector2d& p, double low, double high) const {
    for (int level = static_cast<int>(heights.size()) - 1; level >= 0; --level) {
      const bool in_range = heights[level] >= low && heights[level] <= high;
      if (in_range && levels[level].Holds(p)) return level;
    }
    return std::nullopt;
  }
};

GroundMap::GroundMap(const Environment& environment) : impl_(std::make_unique<Impl>()) {
  std::vector<std::pair<double, Face>> tops;
  for (const Obstacle& obstacle : environment.obstacles) {
    if (obstacle.is_ground && obstacle.surface < 0)
      tops.emplace_back(TopHeight(obstacle), TopFace(obstacle));
  }
  std::stable_sort(tops.begin(), tops.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  for (size_t first = 0; first < tops.size();) {
    std::vector<Face> faces;
    size_t next = first;
    while (next < tops.size() && tops[next].first - tops[first].first <= kAbutting) {
      faces.push_back(tops[next++].second);
    }
    impl_->heights.push_back(tops[first].first);
    impl_->levels.emplace_back(std::move(faces));
    first = next;
  }
}

GroundMap::~GroundMap() = default;
GroundMap::GroundMap(GroundMap&&) noexcept = default;
GroundMap& GroundMap::operator=(GroundMap&&) noexcept = default;

const std::vector<double>& GroundMap::levels() const { return impl_->heights; }

double GroundMap::Clearance(int level, const Vector2d& p) const {
  return impl_->levels.at(level).Clearance(p);
}

bool GroundMap::OneFaceHolds(int level, const Vector2d& from, const Vector2d& to,
                             double radius) const {
  return impl_->levels.at(level).OneFaceHolds(from, to, radius);
}

bool GroundMap::IsNear(int level, const Vector2d& p, double distance) const {
  return impl_->levels.at(level).IsNear(p, distance);
}

std::optional<int> GroundMap::LevelAt(const Vector2d& p, double z, double tolerance) const {
  return impl_->Highest(p, z - tolerance, z + tolerance);
}

std::optional<int> GroundMap::LevelBelow(const Vector2d& p, double z) const {
  constexpr double kAbove = 1e-3;
  return impl_->Highest(p, -kInfinity, z + kAbove);
}

}  // namespace possibility::models
