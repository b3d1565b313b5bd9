#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace possibility::experiments {

/// Triangles (indices of points, counter-clockwise from outside) that cover the convex hull of at
/// most a few dozen points. Empty if they lie in one plane.
std::vector<std::array<int, 3>> HullTriangles(const std::vector<Eigen::Vector3d>& points);

}  // namespace possibility::experiments
