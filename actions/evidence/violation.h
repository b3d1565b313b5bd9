#pragma once

#include <string>

namespace possibility::actions {

/// Kinds of violations; each kind has its own tolerance (docs/verification.md).
enum class ViolationKind {
  kFileMismatch,  ///< robot or scenario is not the plan's
  kStructure,     ///< no segments, unknown contact, times out of order or apart
  kAction,        ///< an action not allowed by the scenario, or one that does not fit its name
  kStart,         ///< the first state is not the scenario's start at rest
  kGoal,          ///< the last state is not a goal at rest
  kBounds,        ///< the root leaves the scenario's bounds
  kPositionContinuity,  ///< q jumps between phases or segments
  kVelocityContinuity,  ///< v jumps between phases or segments, and no impact is declared
  kImpact,              ///< impulses that do not explain the jump of v, or that no ground can give
  kJointPosition,
  kJointSpeed,  ///< a joint, or the root, is too fast
  kJointTorque,
  kJointCoupling,  ///< a mimic joint does not follow its master
  kContactMotion,  ///< a bearing point moves
  kContactGround,  ///< a bearing point is not on ground
  kSchedule,       ///< the motion does not follow the plan's contact schedule
  kPenetration,    ///< a link is inside the environment
  kSelfCollision,
  kDynamics,  ///< tau and forces do not realise the motion
  kFriction,  ///< a contact force leaves its cone or pulls
  kFlight,    ///< centre of mass off its parabola, or angular momentum not kept
  kRollout,   ///< a simulation of the motion ends elsewhere
};

/// "file_mismatch", "structure", ...: the words of the report.
std::string ToString(ViolationKind kind);

/// The worst violation of one kind over the whole plan.
struct Violation {
  ViolationKind kind = ViolationKind::kStructure;
  int segment = -1;      ///< index, or -1
  double time = 0;       ///< s
  std::string quantity;  ///< e.g. "LKP torque", "left_sole point 2 against floor"
  double value = 0;
  double limit = 0;  ///< largest or least accepted value, tolerance included
  std::string unit;  ///< empty if the violation has no measure
};

}  // namespace possibility::actions
