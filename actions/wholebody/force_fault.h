#pragma once

#include <vector>

#include "actions/wholebody/motion_error.h"
#include "dynamics/contact/contact_forces.h"
#include "dynamics/tree/multibody_dynamics.h"

namespace possibility::actions {

/// Why DistributeContactForces finds no forces for the state and acceleration that `dynamics`
/// holds: the limit that binds and the amount, as a clause without time. "right_ankle_roll needs
/// 61.0 of 42.7", "the contacts need a friction of 0.92 of 0.60", "the centre of pressure is 12 mm
/// outside the support". A torque is the least that the worst joint needs if all joints may use the
/// same share of their limits. `settings`: those under which no forces exist.
MotionError ForceFault(dynamics::MultibodyDynamics* dynamics,
                       const std::vector<dynamics::ContactPoint>& points,
                       const dynamics::ContactForceSettings& settings);

}  // namespace possibility::actions
