#include "actions/wholebody/limb_reach.h"

#include <cmath>

#include "actions/wholebody/limb_bend.h"
#include "dynamics/tree/tree_kinematics.h"

namespace possibility::actions {

using Eigen::AngleAxisd;
using Eigen::Vector3d;

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
                  origin(bend->after) - stance.patch_centres[limb], stretch * bend->length};
  }
  return reaches;
}

}  // namespace possibility::actions
