#include "models/world/ground_region.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace possibility::models {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kUnbounded = std::numeric_limits<double>::infinity();

/// Every face grows by this on all sides, so that abutting faces overlap; distances then shrink by
/// it again. Twice this exceeds the gap allowed between abutting faces.
constexpr double kGrowth = 0.6 * GroundRegion::kAbutting;

/// An edge counts as inside another face only if it lies this deep in it, m. Where edges of two
/// faces coincide, rounding must not make each cover the other.
constexpr double kCoverDepth = 1e-9;

/// Up to so many faces or sides, a tree of bounds takes longer than testing them all.
constexpr std::size_t kFew = 16;

/// Sides whose directions differ by less than this (sine) are one side.
constexpr double kStraight = 1e-9;

AlignedBox3d FlatBounds(const Vector2d& p) {
  const Vector3d point(p.x(), p.y(), 0);
  return {point, point};
}

AlignedBox3d FlatBounds(const std::vector<Vector2d>& points) {
  AlignedBox3d bounds;
  for (const Vector2d& p : points) bounds.extend(FlatBounds(p));
  return bounds;
}

double Cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Where two lines n' p = d meet.
Vector2d Meeting(const Vector2d& n1, double d1, const Vector2d& n2, double d2) {
  const double determinant = Cross(n1, n2);
  return Vector2d(d1 * n2.y() - d2 * n1.y(), n1.x() * d2 - n2.x() * d1) / determinant;
}

/// The parts of an edge that other faces do not cover, as shares of it.
std::vector<std::pair<double, double>> UncoveredParts(
    std::vector<std::pair<double, double>> covered) {
  std::sort(covered.begin(), covered.end());
  covered.emplace_back(1, 1);
  std::vector<std::pair<double, double>> parts;
  double reached = 0;
  for (const auto& [first, second] : covered) {
    if (first > reached) parts.emplace_back(reached, first);
    reached = std::max(reached, second);
  }
  return parts;
}

}  // namespace

/// At a sharp corner a side across it keeps the growth small.
GroundRegion::Face::Face(const std::vector<Vector2d>& polygon) {
  std::vector<Vector2d> outward;
  std::vector<double> distances;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d along = polygon[(i + 1) % polygon.size()] - polygon[i];
    if (!(along.norm() > 0)) continue;
    const Vector2d normal = Vector2d(along.y(), -along.x()).normalized();
    if (!outward.empty() && std::abs(Cross(outward.back(), normal)) < kStraight) continue;
    outward.push_back(normal);
    distances.push_back(normal.dot(polygon[i]) + kGrowth);
  }
  while (outward.size() > 1 && std::abs(Cross(outward.back(), outward.front())) < kStraight) {
    outward.pop_back();
    distances.pop_back();
  }
  for (std::size_t i = 0; i < outward.size(); ++i) {
    normals.push_back(outward[i]);
    offsets.push_back(distances[i]);
    const std::size_t next = (i + 1) % outward.size();
    if (outward[i].dot(outward[next]) > -kStraight) continue;
    const Vector2d corner =
        Meeting(outward[i], distances[i] - kGrowth, outward[next], distances[next] - kGrowth);
    const Vector2d across = (outward[i] + outward[next]).normalized();
    normals.push_back(across);
    offsets.push_back(across.dot(corner) + kGrowth);
  }
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const std::size_t before = (i + normals.size() - 1) % normals.size();
    corners.push_back(Meeting(normals[before], offsets[before], normals[i], offsets[i]));
  }
}

bool GroundRegion::Face::Contains(const Vector2d& p) const { return Depth(p) >= 0; }

double GroundRegion::Face::Depth(const Vector2d& p) const {
  double depth = kUnbounded;
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const double own = offsets[i] - normals[i].dot(p);
    if (!(own >= depth)) depth = own;
  }
  return depth;
}

double GroundRegion::Segment::Distance(const Vector2d& p) const {
  const Vector2d along = to - from;
  const double t = along.dot(p - from) / along.squaredNorm();
  return (p - from - std::clamp(t, 0.0, 1.0) * along).norm();
}

GroundRegion::GroundRegion(const std::vector<std::vector<Vector2d>>& faces) {
  std::vector<AlignedBox3d> face_bounds;
  for (const std::vector<Vector2d>& polygon : faces) {
    for (const Vector2d& corner : polygon) bounds_.extend(corner);
    faces_.emplace_back(polygon);
    face_bounds.push_back(FlatBounds(faces_.back().corners));
  }
  face_tree_ = BoundsTree(std::move(face_bounds));
  for (int face = 0; face < static_cast<int>(faces_.size()); ++face) AddBoundary(face);
  std::vector<AlignedBox3d> boundary_bounds;
  for (const Segment& segment : boundary_) {
    boundary_bounds.push_back(FlatBounds(std::vector<Vector2d>{segment.from, segment.to}));
  }
  boundary_tree_ = BoundsTree(std::move(boundary_bounds));
}

/// The part [first, second] of the segment (0 at `from`, 1 at `to`) that lies inside the face by
/// more than kCoverDepth; empty (first >= second) if none does.
std::pair<double, double> GroundRegion::CoveredPart(const Segment& segment, const Face& face) {
  const Vector2d along = segment.to - segment.from;
  double first = 0, second = 1;
  for (std::size_t i = 0; i < face.normals.size(); ++i) {
    const double rate = face.normals[i].dot(along);
    const double inside = face.offsets[i] - kCoverDepth - face.normals[i].dot(segment.from);
    if (std::abs(rate) < kCoverDepth * 1e-3) {
      if (inside <= 0) return {1, 0};
    } else if (rate > 0) {
      second = std::min(second, inside / rate);
    } else {
      first = std::max(first, inside / rate);
    }
  }
  return {first, second};
}

void GroundRegion::AddBoundary(int face) {
  const std::vector<Vector2d>& corners = faces_[face].corners;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Segment edge{corners[i], corners[(i + 1) % corners.size()]};
    std::vector<std::pair<double, double>> covered;
    face_tree_.VisitNear(FlatBounds(std::vector<Vector2d>{edge.from, edge.to}), 0, [&](int other) {
      if (other != face) {
        const std::pair<double, double> part = CoveredPart(edge, faces_[other]);
        if (part.first < part.second) covered.push_back(part);
      }
      return 0.0;
    });
    const Vector2d along = edge.to - edge.from;
    for (const auto& [first, second] : UncoveredParts(std::move(covered))) {
      boundary_.push_back({edge.from + first * along, edge.from + second * along});
    }
  }
}

/// Whether `test` holds for some face. A face that does not hold p fails the test.
template <typename Test>
bool GroundRegion::SomeFaceAt(const Vector2d& p, const Test& test) const {
  if (faces_.size() <= kFew) return std::any_of(faces_.begin(), faces_.end(), test);
  bool found = false;
  face_tree_.VisitNear(FlatBounds(p), 0, [&](int face) {
    found = test(faces_[face]);
    return found ? -1.0 : 0.0;
  });
  return found;
}

bool GroundRegion::IsInside(const Vector2d& p) const {
  return SomeFaceAt(p, [&](const Face& face) { return face.Contains(p); });
}

double GroundRegion::DistanceToBoundary(const Vector2d& p, double at_most) const {
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

double GroundRegion::Clearance(const Vector2d& p) const {
  const double distance = DistanceToBoundary(p, kUnbounded);
  return (IsInside(p) ? distance : -distance) - kGrowth;
}

/// Faces are convex, so a line is closest to their sides at one of its ends.
bool GroundRegion::OneFaceHolds(const Vector2d& from, const Vector2d& to, double radius) const {
  const double needed = radius + kGrowth;
  return SomeFaceAt(from, [&](const Face& face) {
    return face.Depth(from) >= needed && face.Depth(to) >= needed;
  });
}

bool GroundRegion::IsNear(const Vector2d& p, double distance) const {
  return IsInside(p) || DistanceToBoundary(p, distance) < distance;
}

bool GroundRegion::Holds(const Vector2d& p) const {
  return IsInside(p) || DistanceToBoundary(p, kAbutting) + kGrowth < kAbutting;
}

}  // namespace possibility::models
