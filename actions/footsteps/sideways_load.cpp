#include "actions/footsteps/sideways_load.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "dynamics/tree/multibody_dynamics.h"
#include "dynamics/tree/tree_kinematics.h"

namespace possibility::actions {
namespace {

/// A joint rolls if its axis is along the root's x: the cosine of the angle between them, at least.
constexpr double kAlong = 0.7;

/// Of the links that a joint carries, kg.
double MassBeyond(const models::RobotModel& robot, int joint) {
  std::vector<bool> is_beyond(robot.links.size(), false);
  double mass = 0;
  for (int i = joint; i < robot.num_joints(); ++i) {
    const int link = i + 1;
    is_beyond[link] = i == joint || is_beyond[robot.joints[i].parent];
    if (is_beyond[link]) mass += robot.links[link].inertial.mass;
  }
  return mass;
}

}  // namespace

double SidewaysLoad(const models::RobotModel& robot, const NominalStance& stance) {
  dynamics::TreeKinematics kinematics(robot);
  kinematics.SetPosition(stance.q);
  const Eigen::Isometry3d X_RW = kinematics.X_WL()[0].inverse();
  const Eigen::Vector3d centre = X_RW * kinematics.CentreOfMass();
  double most = 0;
  for (const models::GaitLimb& limb : stance.gait->limbs) {
    const auto rolls = [&](int joint) {
      const Eigen::Isometry3d X_RL = X_RW * kinematics.X_WL()[joint + 1];
      return std::abs((X_RL.linear() * robot.joints[joint].axis).x()) > kAlong;
    };
    const auto hip = std::find_if(limb.joints.begin(), limb.joints.end(), rolls);
    if (hip == limb.joints.end()) continue;
    const Eigen::Vector3d place = (X_RW * kinematics.X_WL()[*hip + 1]).translation();
    const double held = robot.TotalMass() - MassBeyond(robot, *hip);
    const double torque = held * dynamics::kGravity * std::abs(place.y() - centre.y());
    most = std::max(most, torque / robot.joints[*hip].effort);
  }
  return most;
}

}  // namespace possibility::actions
