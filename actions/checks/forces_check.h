#pragma once

#include "actions/checks/contacts_check.h"
#include "actions/evidence/verifier_state.h"
#include "actions/evidence/violation_log.h"

namespace possibility::actions {

/// Contact forces that cancel the six unactuated rows, and the corresponding torques.
struct RealisedForces {
  Eigen::Matrix3Xd forces;       ///< 3 x points, world, N
  Eigen::VectorXd torques;       ///< num_joints
  double declared_residual = 0;  ///< largest base row with the declared forces
  double residual = 0;           ///< largest base row that no change can remove
};

/// Inverse dynamics of Simbody at `state` (`dynamics` must be at it) minus the contact forces:
/// `state.knot.forces`, changed as little as possible, each point in proportion to its load: its
/// force along z.
RealisedForces RealiseForces(const VerifierState& state, const std::vector<BearingPoint>& points,
                             const models::RobotModel& robot,
                             const dynamics::SimbodyDynamics& dynamics);

/// Checks dynamics, friction cones and torque limits. `at_knot`: also compares the declared tau and
/// forces with the recomputed ones. `version`: of the plan's format; the motion of version 2 must
/// leave a thousandth of what is tolerated in version 1.
void CheckForces(const VerifierState& state, const PhaseContacts& contacts,
                 const models::RobotModel& robot, const dynamics::SimbodyDynamics& dynamics,
                 bool at_knot, int version, const Instant& at, ViolationLog* log);

}  // namespace possibility::actions
