#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "models/shapes/prepared_shape.h"

namespace possibility::models {

/// Boxes with vertical edges that move together over level ground. They are aligned with the axes
/// of a frame S that rotates about the vertical only. Immutable.
class UprightBoxes {
 public:
  UprightBoxes() = default;
  explicit UprightBoxes(std::vector<Eigen::AlignedBox3d> boxes);

  const std::vector<Eigen::AlignedBox3d>& boxes() const { return boxes_; }  ///< in S
  const std::vector<PreparedShape>& shapes() const { return shapes_; }
  const std::vector<Eigen::Isometry3d>& X_SB() const { return X_SB_; }  ///< poses of the shapes

 private:
  std::vector<Eigen::AlignedBox3d> boxes_;
  std::vector<PreparedShape> shapes_;
  std::vector<Eigen::Isometry3d> X_SB_;
};

/// An upright box in the world, or an upright box around a shape: its footprint seen from above and
/// its range of heights.
struct Prism {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  Eigen::Vector2d x_axis = Eigen::Vector2d::UnitX();  ///< unit
  Eigen::Vector2d half_extents = Eigen::Vector2d::Zero();
  double low = 0;  ///< m
  double high = 0;

  /// The box `box`, given in S.
  Prism(const Eigen::AlignedBox3d& box, const Eigen::Isometry3d& X_WS);
  /// The tightest known upright box around a shape. `bounds`: axis-aligned, in W.
  Prism(const PreparedShape& shape, const Eigen::Isometry3d& X_WC,
        const Eigen::AlignedBox3d& bounds);

  Eigen::AlignedBox3d Bounds() const;
};

/// Separating-axis test: true if some axis separates the two upright boxes by at least `gap`, m;
/// they are then at least that far apart. False if anything is not finite.
bool AreApart(const Prism& a, const Prism& b, double gap);

}  // namespace possibility::models
