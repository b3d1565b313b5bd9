#include "actions/wholebody/limb_bend.h"

#include <algorithm>
#include <cmath>

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

/// What a bend may be: the parts above and below it, and how far both lead along its axis, where it
/// does not matter at which point of the axis the joint is said to be.
struct Parts {
  std::size_t first = 0;  ///< of the limb's joints, the one in which the upper part begins
  Eigen::Vector3d upper = Eigen::Vector3d::Zero();  ///< in that joint's frame, square to the axis
  double lower = 0;                                 ///< m, square to the axis
  double aside = 0;                                 ///< m, along the axis

  double Shorter() const { return std::min(upper.norm(), lower); }
  double Length() const { return std::hypot(upper.norm() + lower, aside); }
};

/// The upper part begins at the last joint before the bend that swings it: hips may have their
/// twist below.
Parts PartsAbout(const models::RobotModel& robot, const models::GaitLimb& limb, std::size_t bend) {
  const auto joint = [&](std::size_t k) -> const models::Joint& {
    return robot.joints[limb.joints[k]];
  };
  Parts parts;
  const bool turns = joint(bend).type == models::JointType::kRevolute;
  const Eigen::Vector3d axis = turns ? joint(bend).axis : Eigen::Vector3d::Zero();
  const Eigen::Vector3d axis_above = joint(bend).X_PJ.linear() * axis;
  const Eigen::Vector3d above = joint(bend).X_PJ.translation();
  const Eigen::Vector3d below = LowerPart(robot, limb, bend);
  parts.first = bend - 1;
  parts.aside = axis_above.dot(above) + axis.dot(below);
  parts.upper = above - axis_above.dot(above) * axis_above;
  parts.lower = (below - axis.dot(below) * axis).norm();
  while (parts.first > 0 && Twists(joint(parts.first), parts.upper) &&
         joint(parts.first).parent == limb.joints[parts.first - 1] + 1) {
    parts.upper = joint(parts.first).X_PJ * parts.upper;
    --parts.first;
  }
  return parts;
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
    const Parts parts = PartsAbout(robot, limb, i);
    if (parts.Shorter() <= shorter) continue;
    shorter = parts.Shorter();
    best = LimbBend{joint(i).name,
                    i,
                    limb.joints[parts.first] + 1,
                    limb.joints[is_last ? i : i + 1] + 1,
                    is_last ? robot.contacts[limb.contact].Centre() : Eigen::Vector3d::Zero(),
                    parts.Length()};
  }
  return best;
}

}  // namespace possibility::actions
