#pragma once

#include <memory>
#include <vector>

#include "collocation/problem/function.h"
#include "dynamics/tree/multibody_dynamics.h"

namespace possibility::collocation {

/// A planar multibody system as functions of one instant, with exact first and second derivatives
/// from dynamics/. q, v, a, f are stacked in that order; f has a horizontal (x) and a vertical (z)
/// component per contact point, world axes, N, on the robot. Each function keeps its own workspace.
/// @throws std::invalid_argument unless the model's base is planar.
using PlanarModel = std::shared_ptr<const dynamics::MultibodyModel>;

}  // namespace possibility::collocation
