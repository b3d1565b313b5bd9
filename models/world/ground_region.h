#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "models/shapes/bounds_tree.h"

namespace possibility::models {

/// The union of convex polygons of one plane, so that abutting ones have no seam. Exact geometry;
/// immutable and safe to share.
class GroundRegion {
 public:
  /// Polygons whose edges differ by less than this belong together, m.
  static constexpr double kAbutting = 1e-6;

  /// `faces`: corners of convex polygons, counter-clockwise, with an area each.
  explicit GroundRegion(const std::vector<std::vector<Eigen::Vector2d>>& faces);

  /// Signed distance from p to the region's edge, m: positive inside. The error is below 1e-6.
  double Clearance(const Eigen::Vector2d& p) const;

  /// True only if one face contains all points within `radius` (m) of the straight line between two
  /// points.
  bool OneFaceHolds(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double radius) const;

  /// Whether p is in the region or at most `distance` (>= 0, m) away from it.
  bool IsNear(const Eigen::Vector2d& p, double distance) const;

  /// Whether the clearance is more than -kAbutting: the very edge belongs to the region.
  bool Holds(const Eigen::Vector2d& p) const;

  Eigen::AlignedBox2d bounds() const { return bounds_; }

 private:
  /// A convex polygon, slightly grown.
  struct Face {
    std::vector<Eigen::Vector2d> corners;
    /// Outward unit normals of the sides, and the sides' distances from the origin.
    std::vector<Eigen::Vector2d> normals;
    std::vector<double> offsets;

    explicit Face(const std::vector<Eigen::Vector2d>& polygon);
    bool Contains(const Eigen::Vector2d& p) const;
    /// How far p lies from the nearest side, negative outside.
    double Depth(const Eigen::Vector2d& p) const;
  };
  struct Segment {
    Eigen::Vector2d from;
    Eigen::Vector2d to;
    double Distance(const Eigen::Vector2d& p) const;
  };

  static std::pair<double, double> CoveredPart(const Segment& segment, const Face& face);
  void AddBoundary(int face);
  template <typename Test>
  bool SomeFaceAt(const Eigen::Vector2d& p, const Test& test) const;
  bool IsInside(const Eigen::Vector2d& p) const;
  /// At most `at_most`.
  double DistanceToBoundary(const Eigen::Vector2d& p, double at_most) const;

  std::vector<Face> faces_;
  BoundsTree face_tree_;
  std::vector<Segment> boundary_;
  BoundsTree boundary_tree_;
  Eigen::AlignedBox2d bounds_;
};

}  // namespace possibility::models
