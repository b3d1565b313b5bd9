#include "actions/motion/limb_bend.h"

#include <algorithm>

namespace possibility::actions {

std::optional<LimbBend> BendOf(const models::RobotModel& robot, const models::GaitLimb& limb) {
  std::optional<LimbBend> best;
  double shorter = 0;
  for (std::size_t i = 1; i + 1 < limb.joints.size(); ++i) {
    const auto joint = [&](std::size_t k) -> const models::Joint& {
      return robot.joints[limb.joints[k]];
    };
    // In a chain each joint stands on the link of the one before.
    if (joint(i).parent != limb.joints[i - 1] + 1 || joint(i + 1).parent != limb.joints[i] + 1) {
      continue;
    }
    const double upper = joint(i).X_PJ.translation().norm();
    const double lower = joint(i + 1).X_PJ.translation().norm();
    if (std::min(upper, lower) <= shorter) continue;
    shorter = std::min(upper, lower);
    best =
        LimbBend{joint(i).name, i, limb.joints[i - 1] + 1, limb.joints[i + 1] + 1, upper + lower};
  }
  return best;
}

}  // namespace possibility::actions
