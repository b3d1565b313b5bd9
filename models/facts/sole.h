#pragma once

#include <Eigen/Core>
#include <vector>

#include "models/robot/robot_model.h"

namespace possibility::models {

/// The part of a link that bears on level ground.
struct Sole {
  std::vector<Eigen::Vector3d> points;  ///< in the link's frame, counter-clockwise from above, m
  double area = 0;                      ///< m^2; 0 for an edge or a point
  double depth = 0;  ///< m: how far above the lowest point the shapes may be at the corners
};

/// The lowest polygon of a link's shapes if its axes are turned by R_WL: the convex outline, seen
/// from above, of what is within `slack` (m) of the lowest point, put at the lowest point's height.
/// Of outlines with more than `most_corners` those corners are left out that cost the least area,
/// so the polygon stays within the outline.
Sole SoleOf(const Link& link, const Eigen::Matrix3d& R_WL, double slack, int most_corners = 6);

}  // namespace possibility::models
