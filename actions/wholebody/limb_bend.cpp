#include "actions/wholebody/limb_bend.h"

#include <algorithm>

namespace possibility::actions {
namespace {

/// Sine of the angle between a joint's axis and the part that it turns, below which it twists that
/// part and does not swing it.
constexpr double kTwist = 0.3;

/// Whether a joint twists the part from it to p, in the frame that it moves.
bool Twists(const models::Joint& joint, const Eigen::Vector3d& p) {
  return joint.type == models::JointType::kRevolute &&
         joint.axis.cross(p).norm() < kTwist * p.norm();
}

/// From a joint of the limb to the next one, or to the contact that the limb ends in.
Eigen::Vector3d LowerPart(const models::RobotModel& robot, const models::GaitLimb& limb,
                          std::size_t k) {
  if (k + 1 < limb.joints.size()) return robot.joints[limb.joints[k + 1]].X_PJ.translation();
  return robot.contacts[limb.contact].Centre();
}

/// The upper part begins at the last joint before the bend that swings it: hips may have their
/// twist below.
void FindUpperPart(const models::RobotModel& robot, const models::GaitLimb& limb, LimbBend* bend) {
  const auto joint = [&](std::size_t k) -> const models::Joint& {
    return robot.joints[limb.joints[k]];
  };
  std::size_t first = bend->joint - 1;
  Eigen::Vector3d upper = joint(bend->joint).X_PJ.translation();
  while (first > 0 && Twists(joint(first), upper) &&
         joint(first).parent == limb.joints[first - 1] + 1) {
    upper = joint(first).X_PJ * upper;
    --first;
  }
  bend->before = limb.joints[first] + 1;
  bend->length = upper.norm() + LowerPart(robot, limb, bend->joint).norm();
}

}  // namespace

std::optional<LimbBend> BendOf(const models::RobotModel& robot, const models::GaitLimb& limb) {
  std::optional<LimbBend> best;
  double shorter = 0;
  for (std::size_t i = 1; i < limb.joints.size(); ++i) {
    const auto joint = [&](std::size_t k) -> const models::Joint& {
      return robot.joints[limb.joints[k]];
    };
    const bool is_last = i + 1 == limb.joints.size();
    // In a chain each joint stands on the link of the one before.
    const bool goes_on = is_last ? robot.contacts[limb.contact].link == limb.joints[i] + 1
                                 : joint(i + 1).parent == limb.joints[i] + 1;
    if (joint(i).parent != limb.joints[i - 1] + 1 || !goes_on) continue;
    const double upper = joint(i).X_PJ.translation().norm();
    const double lower = LowerPart(robot, limb, i).norm();
    if (std::min(upper, lower) <= shorter) continue;
    shorter = std::min(upper, lower);
    best = LimbBend{joint(i).name,
                    i,
                    limb.joints[i - 1] + 1,
                    limb.joints[is_last ? i : i + 1] + 1,
                    is_last ? robot.contacts[limb.contact].Centre() : Eigen::Vector3d::Zero(),
                    upper + lower};
  }
  if (best) FindUpperPart(robot, limb, &*best);
  return best;
}

}  // namespace possibility::actions
