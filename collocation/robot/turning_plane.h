#pragma once

#include <memory>
#include <vector>

#include "collocation/problem/function.h"
#include "collocation/robot/multibody_functions.h"

namespace possibility::collocation {

/// Heights of points over a plane parallel to the y axis, m. Its normal is (-sin turn, 0, cos
/// turn); `offset` is its distance from the origin along the normal. Turn and offset may be
/// variables: a plane that the solver turns keeps a robot off a body for which no one fixed plane
/// would do. Inputs: q, turn (rad), offset (m). `model`: in space.
std::shared_ptr<Function> HeightsOverTurningPlane(
    const RobotSystem& model, const std::vector<dynamics::ContactPoint>& points);

}  // namespace possibility::collocation
