#pragma once

#include <Eigen/Core>
#include <vector>

#include "actions/verify/verifier_log.h"
#include "actions/verify/verifier_state.h"
#include "models/world/ground_map.h"

namespace possibility::actions {

/// What bears during one phase, and where each point was when it was set down: until it has left
/// the ground it must not have moved from there, whether the phases list it or not.
struct PhaseContacts {
  std::vector<BearingPoint> points;
  Eigen::Matrix3Xd anchors;  ///< world, one column per point, m
  bool lands = false;        ///< some point is set down when the phase begins
};

/// The contacts of all phases of all segments, in order.
std::vector<PhaseContacts> FollowContacts(const Plan& plan, const models::RobotModel& robot,
                                          const models::GroundMap& ground,
                                          StateEvaluator* evaluator);

/// Bearing points stay where they were, at rest, on ground.
void CheckContacts(const VerifierState& state, const PhaseContacts& contacts,
                   const models::RobotModel& robot, const models::GroundMap& ground,
                   const Instant& at, ViolationLog* log);

}  // namespace possibility::actions
