#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace possibility::models {

/// Cuts a polygon in space, about flat and not necessarily convex, into triangles of its corners
/// with the same sense of rotation, by clipping ears. Always two triangles fewer than corners: of a
/// polygon that crosses itself some are arbitrary. Empty for fewer than three corners.
std::vector<std::array<int, 3>> Triangulated(const std::vector<Eigen::Vector3d>& corners);

}  // namespace possibility::models
