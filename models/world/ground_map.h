#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "models/world/environment.h"

namespace possibility::models {

/// The ground as a set of levels: at each height, the union of all coplanar ground faces, so
/// that faces which abut have no seam. Exact geometry; immutable and safe to share.
class GroundMap {
 public:
  /// Faces whose edges or heights differ by less than this belong together, m.
  static constexpr double kAbutting = 1e-6;

  /// Ground that another solid covers is still ground here.
  /// @throws InputError naming the obstacle if one that is ground is not an upright box.
  explicit GroundMap(const Environment& environment);
  ~GroundMap();
  GroundMap(GroundMap&&) noexcept;
  GroundMap& operator=(GroundMap&&) noexcept;

  /// Heights of the levels, ascending, m.
  const std::vector<double>& levels() const;

  /// Signed distance in the plane from (x, y) to the edge of the ground of a level: positive
  /// inside (ground everywhere within that distance), negative outside. Errs by less than 1e-6.
  /// @throws std::out_of_range unless there is such a level.
  double Clearance(int level, const Eigen::Vector2d& p) const;

  /// True only if all that lies within `radius` (m) of the straight line between two points is
  /// ground of a level; so is then the Clearance of each point of the line at least `radius`, its
  /// error aside. False if it takes more than one face to tell. Costs a fraction of Clearance.
  /// @throws std::out_of_range unless there is such a level.
  bool OneFaceHolds(int level, const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                    double radius) const;

  /// Whether p is ground of a level or no farther than `distance` (>= 0, m) from it: whether its
  /// Clearance is at least -`distance`, sooner known. False for what is not finite.
  /// @throws std::out_of_range unless there is such a level.
  bool IsNear(int level, const Eigen::Vector2d& p, double distance) const;

  /// The level whose height is within `tolerance` of z and that has ground at p; the highest
  /// one if several; none otherwise.
  std::optional<int> LevelAt(const Eigen::Vector2d& p, double z, double tolerance) const;

  /// The highest ground at or below z (plus 1 mm) under p.
  std::optional<int> LevelBelow(const Eigen::Vector2d& p, double z) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace possibility::models
