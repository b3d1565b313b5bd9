#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace possibility::models {

/// A convex polygon in the plane, counter-clockwise, without corners on its sides.
using ConvexPolygon = std::vector<Eigen::Vector2d>;

double AreaOf(const ConvexPolygon& polygon);

/// The convex hull; corners nearer than `slack` (m) to the line of their neighbours are left out.
ConvexPolygon HullOf(std::vector<Eigen::Vector2d> points, double slack);

/// A partition of triangles (counter-clockwise, without overlap) into fewer convex polygons:
/// greedy, across sides that two triangles share, while the union is convex to within kConvexSlack.
std::vector<ConvexPolygon> MergedConvex(const std::vector<Eigen::Vector2d>& points,
                                        const std::vector<std::array<int, 3>>& triangles);

/// m: no corner of a part lies deeper than this inside the union's sides.
inline constexpr double kConvexSlack = 5e-6;

}  // namespace possibility::models
