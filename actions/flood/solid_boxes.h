#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "models/shapes/bounds_tree.h"
#include "models/world/environment.h"

namespace possibility::actions {

/// The obstacles of an environment that are upright boxes: solid, so anything inside one is in
/// collision. Immutable.
class SolidBoxes {
 public:
  explicit SolidBoxes(const models::Environment& environment);

  /// Whether all of `box` lies inside a single obstacle.
  bool OneHolds(const Eigen::AlignedBox3d& box) const;

 private:
  struct Box {
    Eigen::Isometry2d X_BW;  ///< seen from above
    Eigen::Vector2d half_extents;
    double low;
    double high;
  };
  static bool Holds(const Box& solid, const Eigen::AlignedBox3d& box);

  std::vector<Box> boxes_;
  models::BoundsTree tree_;
};

}  // namespace possibility::actions
