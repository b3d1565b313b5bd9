#pragma once

#include <Eigen/Core>
#include <vector>

#include "actions/verifier_log.h"
#include "actions/verifier_state.h"
#include "models/ground_map.h"

namespace possibility::actions {

/// What bears during one phase, and where each point was when its bearing began: a patch that
/// stays listed from phase to phase, across segments too, must not have moved since.
struct PhaseContacts {
  std::vector<BearingPoint> points;
  Eigen::Matrix3Xd anchors;  ///< world, one column per point, m
};

/// The contacts of all phases of all segments, in order.
std::vector<PhaseContacts> FollowContacts(const Plan& plan, const models::RobotModel& robot,
                                          StateEvaluator* evaluator);

/// Bearing points stay where they were, at rest, on ground.
void CheckContacts(const VerifierState& state, const PhaseContacts& contacts,
                   const models::RobotModel& robot, const models::GroundMap& ground,
                   const Instant& at, ViolationLog* log);

}  // namespace possibility::actions
