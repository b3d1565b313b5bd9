#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "models/shapes/prepared_shape.h"

namespace possibility::models {

/// Boxes with vertical edges that move as one over level ground: a frame S that turns about the
/// vertical alone, and boxes along its axes. Immutable.
class UprightBoxes {
 public:
  UprightBoxes() = default;
  explicit UprightBoxes(std::vector<Eigen::AlignedBox3d> boxes);

  const std::vector<Eigen::AlignedBox3d>& boxes() const { return boxes_; }  ///< in S
  const std::vector<PreparedShape>& shapes() const { return shapes_; }
  const std::vector<Eigen::Isometry3d>& X_SB() const { return X_SB_; }  ///< of the shapes

 private:
  std::vector<Eigen::AlignedBox3d> boxes_;
  std::vector<PreparedShape> shapes_;
  std::vector<Eigen::Isometry3d> X_SB_;
};

/// An upright box in the world, or one around a shape: what the shape covers seen from above, and
/// between which heights.
struct Prism {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  Eigen::Vector2d x_axis = Eigen::Vector2d::UnitX();  ///< unit
  Eigen::Vector2d half_extents = Eigen::Vector2d::Zero();
  double low = 0;  ///< m
  double high = 0;

  /// The box `box` of S.
  Prism(const Eigen::AlignedBox3d& box, const Eigen::Isometry3d& X_WS);
  /// The tightest of those known around a shape. `bounds`: axis-aligned, in W.
  Prism(const PreparedShape& shape, const Eigen::Isometry3d& X_WC,
        const Eigen::AlignedBox3d& bounds);

  Eigen::AlignedBox3d Bounds() const;
};

/// Whether some axis that an upright box can be told from another by separates the two by at least
/// `gap`, m: then they are at least that far apart. False if anything is not finite.
bool AreApart(const Prism& a, const Prism& b, double gap);

}  // namespace possibility::models
