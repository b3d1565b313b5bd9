#pragma once

#include <Eigen/Core>
#include <vector>

namespace possibility::actions {

/// Convex hull of the bearing points seen from above, counter-clockwise. May degenerate to a
/// segment or a point.
class SupportPolygon {
 public:
  explicit SupportPolygon(const std::vector<Eigen::Vector2d>& points);

  const std::vector<Eigen::Vector2d>& vertices() const { return vertices_; }

  /// Distance to the nearest edge, positive inside.
  double Margin(const Eigen::Vector2d& p) const;

  /// The point closest to `preferred` that keeps `margin` from every edge; if there is none, the
  /// closest point with the largest possible margin (to 1 mm).
  Eigen::Vector2d Nearest(const Eigen::Vector2d& preferred, double margin) const;

 private:
  std::vector<Eigen::Vector2d> Shrunk(double margin) const;

  std::vector<Eigen::Vector2d> vertices_;
};

}  // namespace possibility::actions
