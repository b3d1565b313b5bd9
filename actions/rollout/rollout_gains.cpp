#include "actions/rollout/rollout_gains.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "dynamics/tree/tree_kinematics.h"

namespace possibility::actions {

Eigen::VectorXd JointStiffness(const models::RobotModel& robot, const RolloutGains& gains) {
  if (gains.stiffness.size() > 0) {
    if (gains.stiffness.size() != robot.num_joints()) {
      throw std::invalid_argument(
          fmt::format("RolloutGains: stiffness has {} elements, expected {}",
                      gains.stiffness.size(), robot.num_joints()));
    }
    return gains.stiffness;
  }
  Eigen::VectorXd stiffness(robot.num_joints());
  // Joints without a limit would get an infinite gain.
  for (int j = 0; j < robot.num_joints(); ++j) {
    const double effort = robot.joints[j].effort;
    stiffness[j] = std::isfinite(effort) ? effort / gains.full_effort_error : 0;
  }
  if (robot.gaits.empty()) return stiffness;
  const double tipping =
      robot.TotalMass() * dynamics::kGravity * robot.gaits.front().posture.root_height;
  for (const int j : robot.LegJoints()) {
    if (robot.joints[j].type == models::JointType::kPrismatic || stiffness[j] == 0) continue;
    stiffness[j] = std::max(stiffness[j], gains.standing_stiffness * tipping);
  }
  return stiffness;
}

}  // namespace possibility::actions
