#pragma once

#include <Eigen/Geometry>
#include <memory>

#include "models/shapes/shape.h"

class btConvexShape;

namespace possibility::models {

/// A shape prepared for many distance queries: a convex core swept with a ball of `radius`. The
/// core of a sphere is a point, that of a capsule a segment, that of any other shape the shape
/// itself. Curvature due to the radius thus costs no accuracy. The core lives in frame C: axes
/// parallel to the shape's frame S, origin at the centre of the core's bounding box in S.
/// Immutable; copies are cheap and may be shared between threads.
class PreparedShape {
 public:
  /// @throws InputError if `shape` is a mesh without vertices.
  explicit PreparedShape(const Shape& shape);

  /// Point of the core farthest along `direction`, frame C.
  Eigen::Vector3d CoreSupport(const Eigen::Vector3d& direction) const;

  /// Half extents of the core's bounding box in C; exactly the core if `core_is_box()`.
  const Eigen::Vector3d& half_extents() const { return half_extents_; }
  /// True for boxes, segments (two half extents are 0) and points (all three are 0).
  bool core_is_box() const { return core_is_box_; }
  bool core_is_point() const { return core_is_box_ && half_extents_.isZero(0); }
  double radius() const { return radius_; }
  const Eigen::Vector3d& p_SC() const { return p_SC_; }

  /// Pose of C, given the pose of S.
  Eigen::Isometry3d CorePose(const Eigen::Isometry3d& X_WS) const;

  /// Axis-aligned box in W that contains the shape; the tightest one for boxes, spheres and
  /// capsules. All of space if the pose is not finite, so that nothing is ruled out.
  Eigen::AlignedBox3d OuterBounds(const Eigen::Isometry3d& X_WC) const;

  /// The core as a Bullet shape, margin 0.
  const btConvexShape& bullet_core() const { return *bullet_core_; }

 private:
  std::shared_ptr<const Shape> core_;  ///< in frame C
  Eigen::Vector3d half_extents_;
  Eigen::Vector3d p_SC_ = Eigen::Vector3d::Zero();
  double radius_ = 0;
  bool core_is_box_ = true;
  std::shared_ptr<const btConvexShape> bullet_core_;
};

}  // namespace possibility::models
