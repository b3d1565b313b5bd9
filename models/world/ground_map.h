#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <optional>
#include <vector>

#include "models/world/environment.h"

namespace possibility::models {

/// A plane that holds ground: `normal' p = offset`.
struct GroundPlane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< unit, upward
  double offset = 0;                                  ///< m
  double friction = kRobotsFriction;                  ///< the lesser of this and the robot's counts

  /// Of the plane above or below a point seen from above, m.
  double HeightAt(const Eigen::Vector2d& p) const {
    return (offset - normal.head<2>().dot(p)) / normal.z();
  }
};

/// The ground as a set of planes: in each, the union of all coplanar ground faces of one friction,
/// so that abutting faces have no seam. The first planes are the levels: horizontal, and as much
/// friction as the robot has. All others are rough ground, for single steps: tilted or slippery, or
/// the top of an obstacle. Exact geometry; immutable and safe to share.
///
/// Points with two coordinates are places seen from above. Distances from the ground of a plane are
/// measured in the plane.
class GroundMap {
 public:
  /// Faces whose edges or heights differ by less than this belong together, m.
  static constexpr double kAbutting = 1e-6;
  /// No ground is steeper, rad.
  static constexpr double kSteepest = 0.78539816339744831;

  /// Ground that another solid covers still counts as ground. `friction`: the robot's coefficient.
  /// With 0 no ground is slippery, and of level ground of one height the least friction counts.
  /// @throws InputError naming the obstacle if one that is ground is not a box, or has no side that
  /// faces up; or if a face is no convex polygon of one plane that faces up.
  explicit GroundMap(const Environment& environment, double friction = 0);
  ~GroundMap();
  GroundMap(GroundMap&&) noexcept;
  GroundMap& operator=(GroundMap&&) noexcept;

  /// Heights of the levels, ascending, m.
  const std::vector<double>& levels() const;
  /// All planes; the first ones are the levels.
  const std::vector<GroundPlane>& planes() const;
  /// Around all ground, m.
  Eigen::AlignedBox3d bounds() const;

  /// Signed distance in the plane from (x, y) to the edge of the plane's ground, m: positive inside
  /// (ground everywhere within that distance), negative outside. The error is below 1e-6.
  /// @throws std::out_of_range unless there is such a plane.
  double Clearance(int plane, const Eigen::Vector2d& p) const;

  /// True only if one face of a plane contains all points within `radius` (m) of the straight line
  /// between two points. The Clearance of each point of the line is then at least `radius`, up to
  /// its error. False if more than one face is needed. Costs a fraction of Clearance.
  /// @throws std::out_of_range unless there is such a plane.
  bool OneFaceHolds(int plane, const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                    double radius) const;

  /// Whether p is ground of a plane or at most `distance` (>= 0, m) away from it, that is, whether
  /// its Clearance is at least -`distance`; faster than Clearance. False if p is not finite.
  /// @throws std::out_of_range unless there is such a plane.
  bool IsNear(int plane, const Eigen::Vector2d& p, double distance) const;

  /// Whether rough ground is at most `distance` (>= 0, m) away from p, in space. Levels do not
  /// count. False if p is not finite.
  bool RoughGroundIsNear(const Eigen::Vector3d& p, double distance) const;

  /// Planes whose ground may be at most `distance` (>= 0, m) away from p, in space; ascending. All
  /// such planes are among them.
  std::vector<int> PlanesNear(const Eigen::Vector3d& p, double distance) const;

  /// The level whose height is within `tolerance` of z and that has ground at p; the highest one if
  /// there are several; nothing otherwise.
  std::optional<int> LevelAt(const Eigen::Vector2d& p, double z, double tolerance) const;

  /// The highest ground of a level at or below z (plus 1 mm) under p.
  std::optional<int> LevelBelow(const Eigen::Vector2d& p, double z) const;

  /// All planes that have ground at p, and whose height there is within [low, high], m.
  std::vector<int> PlanesAt(const Eigen::Vector2d& p, double low, double high) const;

  /// The highest ground at or below z (plus 1 mm) under p, m.
  std::optional<double> HeightBelow(const Eigen::Vector2d& p, double z) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace possibility::models
