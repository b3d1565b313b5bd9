#pragma once

#include <Eigen/Core>
#include <vector>

#include "models/robot/robot_model.h"

namespace possibility::actions {

/// Corners of a polytope around the shapes, in the link's frame, m: round shapes lie in prisms.
std::vector<Eigen::Vector3d> CornersOf(const std::vector<models::PosedShape>& shapes);

}  // namespace possibility::actions
