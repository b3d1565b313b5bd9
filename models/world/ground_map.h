#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "models/world/environment.h"

namespace possibility::models {

/// The ground as a set of levels: at each height, the union of all coplanar ground faces, so that
/// abutting faces have no seam. Exact geometry; immutable and safe to share.
class GroundMap {
 public:
  /// Faces whose edges or heights differ by less than this belong together, m.
  static constexpr double kAbutting = 1e-6;

  /// Ground that another solid covers still counts as ground.
  /// @throws InputError naming the obstacle if one that is ground is not an upright box.
  explicit GroundMap(const Environment& environment);
  ~GroundMap();
  GroundMap(GroundMap&&) noexcept;
  GroundMap& operator=(GroundMap&&) noexcept;

  /// Heights of the levels, ascending, m.
  const std::vector<double>& levels() const;

  /// Signed distance in the plane from (x, y) to the edge of the ground of a level, m: positive
  /// inside (ground everywhere within that distance), negative outside. The error is below 1e-6.
  /// @throws std::out_of_range unless there is such a level.
  double Clearance(int level, const Eigen::Vector2d& p) const;

  /// True only if one face of a level contains all points within `radius` (m) of the straight line
  /// between two points. The Clearance of each point of the line is then at least `radius`, up to
  /// its error. False if more than one face is needed. Costs a fraction of Clearance.
  /// @throws std::out_of_range unless there is such a level.
  bool OneFaceHolds(int level, const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                    double radius) const;

  /// Whether p is ground of a level or at most `distance` (>= 0, m) away from it, that is, whether
  /// its Clearance is at least -`distance`; faster than Clearance. False if p is not finite.
  /// @throws std::out_of_range unless there is such a level.
  bool IsNear(int level, const Eigen::Vector2d& p, double distance) const;

  /// The level whose height is within `tolerance` of z and that has ground at p; the highest one if
  /// there are several; nothing otherwise.
  std::optional<int> LevelAt(const Eigen::Vector2d& p, double z, double tolerance) const;

  /// The highest ground at or below z (plus 1 mm) under p.
  std::optional<int> LevelBelow(const Eigen::Vector2d& p, double z) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace possibility::models
