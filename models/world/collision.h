#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "models/robot/robot_model.h"
#include "models/shapes/prepared_shape.h"
#include "models/shapes/upright_boxes.h"
#include "models/world/environment.h"

namespace possibility::models {

/// A pair of shapes closer than the threshold. `distance` is signed: negative when they overlap
/// (depth of penetration), m.
struct Proximity {
  int link = -1;   ///< robot link
  int other = -1;  ///< obstacle index, or the second link
  double distance = 0;
};

/// Collision queries in double precision, of robot links against obstacles and against each other.
/// Distances are never too large, and too small by less than 0.05 mm. A pose that is not finite
/// counts as a collision. Immutable: const queries may run in several threads.
class CollisionChecker {
 public:
  /// Copies what it needs of both.
  CollisionChecker(const RobotModel& robot, const Environment& environment);
  /// Without a robot, for queries of single shapes.
  explicit CollisionChecker(const Environment& environment);
  ~CollisionChecker();
  CollisionChecker(CollisionChecker&&) noexcept;
  CollisionChecker& operator=(CollisionChecker&&) noexcept;

  /// All (link, obstacle) pairs whose signed distance is below `threshold` (m), sorted by link,
  /// then by obstacle. If a link has several shapes, the nearest one counts.
  /// `X_WL`: pose of every link in the world.
  /// @throws std::invalid_argument unless there is one pose per link.
  std::vector<Proximity> EnvironmentProximities(const std::vector<Eigen::Isometry3d>& X_WL,
                                                double threshold) const;

  /// All link pairs below `threshold`, except parent and child and RobotModel's ignored pairs;
  /// `link` < `other`, sorted.
  /// @throws std::invalid_argument unless there is one pose per link.
  std::vector<Proximity> SelfProximities(const std::vector<Eigen::Isometry3d>& X_WL,
                                         double threshold) const;

  /// True if `shape` posed at X_WS keeps at least `margin` (>= 0) from every obstacle. Never
  /// wrongly true; false already up to 0.05 mm outside the margin. A shape that touches an obstacle
  /// is not free.
  bool IsFree(const PreparedShape& shape, const Eigen::Isometry3d& X_WS, double margin) const;
  bool IsFree(const Shape& shape, const Eigen::Isometry3d& X_WS, double margin) const;

  /// True if every box posed by X_WS is free. X_WS rotates about the vertical only. Same answer as
  /// IsFree of each box with margin 0, but faster.
  bool AreFree(const UprightBoxes& boxes, const Eigen::Isometry3d& X_WS) const;

  /// True only if all upright boxes keep at least kCertainGap from every obstacle; IsFree then
  /// holds for any shape inside them. False says nothing. Costs a fraction of IsFree.
  bool AreCertainlyFree(const std::vector<Prism>& boxes) const;

  /// Larger than the error of a distance, m.
  static constexpr double kCertainGap = 1e-4;

  /// Signed distance (m) from `shape` posed at X_WS to the nearest obstacle, or `at_most` if none
  /// is nearer. Never too large; too small by at most 0.05 mm.
  double Clearance(const PreparedShape& shape, const Eigen::Isometry3d& X_WS, double at_most) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace possibility::models
