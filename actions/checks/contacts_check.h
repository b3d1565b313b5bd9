#pragma once

#include <Eigen/Core>
#include <vector>

#include "actions/evidence/verifier_state.h"
#include "actions/evidence/violation_log.h"
#include "models/world/ground_map.h"

namespace possibility::actions {

/// Bearing points of one phase, and the place where each was set down. A point must not move from
/// there until it leaves the ground, whether or not the phases list it.
struct PhaseContacts {
  std::vector<BearingPoint> points;
  Eigen::Matrix3Xd anchors;  ///< world, one column per point, m
  Eigen::Matrix3Xd normals;  ///< of the ground at the points, unit, one column per point
  Eigen::VectorXd friction;  ///< coefficients at the points
  bool lands = false;        ///< some point is set down at the start of the phase
};

/// The contacts of all phases of all segments, in order.
std::vector<PhaseContacts> FollowContacts(const Plan& plan, const models::RobotModel& robot,
                                          const models::GroundMap& ground,
                                          StateEvaluator* evaluator);

/// Checks that bearing points are at rest on ground, at their anchors.
void CheckContacts(const VerifierState& state, const PhaseContacts& contacts,
                   const models::RobotModel& robot, const models::GroundMap& ground,
                   const Instant& at, ViolationLog* log);

}  // namespace possibility::actions
