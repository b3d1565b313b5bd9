#pragma once

#include <Eigen/Core>
#include <vector>

#include "models/shapes/shape.h"

namespace possibility::actions {

/// Corners of a shape's core (models::PreparedShape) in the shape's frame, m: their hull, swept
/// with a ball of the shape's radius, contains the shape.
std::vector<Eigen::Vector3d> CoreCorners(const models::Shape& shape);

}  // namespace possibility::actions
