#pragma once

#include <Eigen/Core>

#include "dynamics/tree/multibody_dynamics.h"

namespace possibility::actions {

/// Where the contact forces on level ground at height `ground` (m) have no horizontal moment
/// (Vukobratovic and Borovac 2004), from the inverse dynamics of the state and acceleration that
/// `dynamics` holds. World, m. Infinite if the ground need not bear anything.
Eigen::Vector2d RequiredZeroMomentPoint(dynamics::MultibodyDynamics* dynamics, double ground);

}  // namespace possibility::actions
