#include "actions/wholebody/limb_reach.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "actions/wholebody/limb_bend.h"
#include "dynamics/tree/tree_kinematics.h"

namespace possibility::actions {

using Eigen::AngleAxisd;
using Eigen::Vector3d;

namespace {

/// Of the bend's range, rad: the rest of the limb is not as in the nominal posture.
constexpr double kFromLimit = 0.03;

/// Greatest distance between the ends of both parts while the bend turns in a range, as a share of
/// that without limits. The square of the distance is mean + amplitude cos(angle - straight).
double ShareWithin(const models::RobotModel& robot, const models::GaitLimb& limb,
                   const LimbBend& bend, double lower, double upper) {
  dynamics::TreeKinematics kinematics(robot);
  Eigen::VectorXd q = Eigen::VectorXd::Zero(robot.nq());
  q[0] = 1;
  const auto squared = [&](double angle) {
    q[7 + limb.joints[bend.joint]] = angle;
    kinematics.SetPosition(q);
    return (kinematics.Position(bend.after, bend.end) -
            kinematics.X_WL()[bend.before].translation())
        .squaredNorm();
  };
  const double at_zero = squared(0), at_half_turn = squared(std::numbers::pi);
  const double mean = (at_zero + at_half_turn) / 2;
  const double cosine = at_zero - mean;
  const double sine = squared(std::numbers::pi / 2) - mean;
  const double amplitude = std::hypot(cosine, sine);
  const double straight = std::atan2(sine, cosine);
  const auto off = [&](double angle) { return std::abs(WrapAngle(angle - straight)); };
  if (std::abs(WrapAngle(straight - (lower + upper) / 2)) <= (upper - lower) / 2) return 1;
  const double least = std::min(off(lower), off(upper));
  return std::sqrt((mean + amplitude * std::cos(least)) / (mean + amplitude));
}

/// m, of the limb if the bend is as straight as its range allows.
double UsableLength(const models::RobotModel& robot, const models::GaitLimb& limb,
                    const LimbBend& bend, double stretch) {
  const models::Joint& joint = robot.joints[limb.joints[bend.joint]];
  if (joint.type != models::JointType::kRevolute) return stretch * bend.length;
  const double share =
      ShareWithin(robot, limb, bend, joint.lower + kFromLimit, joint.upper - kFromLimit);
  return stretch * share * bend.length;
}

}  // namespace

std::optional<double> LimbReach::HighestRoot(const PlanarPose& root, const Vector3d& centre,
                                             const Eigen::Matrix3d& turned) const {
  const Vector3d foot = centre + turned * ankle;
  const Vector3d from_root = AngleAxisd(root.yaw, Vector3d::UnitZ()) * hip;
  const double away = (foot.head<2>() - root.position() - from_root.head<2>()).squaredNorm();
  const double squared = length * length - away;
  if (squared < 0) return std::nullopt;
  return foot.z() + std::sqrt(squared) - from_root.z();
}

std::vector<std::optional<LimbReach>> ReachesOf(const models::RobotModel& robot,
                                                const NominalStance& stance, double stretch) {
  dynamics::TreeKinematics kinematics(robot);
  kinematics.SetPosition(stance.q);
  const auto origin = [&](int link) -> Vector3d { return kinematics.X_WL()[link].translation(); };
  std::vector<std::optional<LimbReach>> reaches;
  for (std::size_t limb = 0; limb < stance.gait->limbs.size(); ++limb) {
    reaches.emplace_back();
    const std::optional<LimbBend> bend = BendOf(robot, stance.gait->limbs[limb]);
    if (!bend) continue;
    reaches.back() =
        LimbReach{origin(bend->before) - origin(0),
                  kinematics.Position(bend->after, bend->end) - stance.patch_centres[limb],
                  UsableLength(robot, stance.gait->limbs[limb], *bend, stretch)};
  }
  return reaches;
}

}  // namespace possibility::actions
