#include "actions/evidence/violation.h"

#include <stdexcept>

namespace possibility::actions {

std::string ToString(ViolationKind kind) {
  switch (kind) {
    case ViolationKind::kFileMismatch:
      return "file_mismatch";
    case ViolationKind::kStructure:
      return "structure";
    case ViolationKind::kAction:
      return "action";
    case ViolationKind::kStart:
      return "start";
    case ViolationKind::kGoal:
      return "goal";
    case ViolationKind::kBounds:
      return "bounds";
    case ViolationKind::kPositionContinuity:
      return "position_continuity";
    case ViolationKind::kVelocityContinuity:
      return "velocity_continuity";
    case ViolationKind::kImpact:
      return "impact";
    case ViolationKind::kJointPosition:
      return "joint_position";
    case ViolationKind::kJointSpeed:
      return "joint_speed";
    case ViolationKind::kJointTorque:
      return "joint_torque";
    case ViolationKind::kJointCoupling:
      return "joint_coupling";
    case ViolationKind::kContactMotion:
      return "contact_motion";
    case ViolationKind::kContactGround:
      return "contact_ground";
    case ViolationKind::kSchedule:
      return "schedule";
    case ViolationKind::kPenetration:
      return "penetration";
    case ViolationKind::kSelfCollision:
      return "self_collision";
    case ViolationKind::kDynamics:
      return "dynamics";
    case ViolationKind::kFriction:
      return "friction";
    case ViolationKind::kFlight:
      return "flight";
    case ViolationKind::kRollout:
      return "rollout";
  }
  throw std::invalid_argument("unknown kind of violation");
}

}  // namespace possibility::actions
