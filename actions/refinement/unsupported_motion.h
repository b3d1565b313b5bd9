#pragma once

#include <Eigen/Core>

#include "actions/evidence/verifier_state.h"
#include "dynamics/simbody/simbody_dynamics.h"

namespace possibility::actions {

/// An orthonormal basis (6 x n) of the motions of a rigid robot that its bearing points do not
/// resist: rows 0-2 angular, 3-5 linear velocity of the root. Six in flight, one if all points are
/// on one line, none if they support the robot. Contact forces do no work on them.
Eigen::Matrix<double, 6, Eigen::Dynamic> UnsupportedMotions(
    const VerifierState& state, const std::vector<BearingPoint>& points);

/// What no contact force can balance: inverse dynamics of `state` (`dynamics` must be at it) along
/// those motions, N and N m.
Eigen::VectorXd UnsupportedForces(const Eigen::Matrix<double, 6, Eigen::Dynamic>& motions,
                                  const VerifierState& state,
                                  const dynamics::SimbodyDynamics& dynamics);

}  // namespace possibility::actions
