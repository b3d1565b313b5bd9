#include "actions/gait/waist_joint.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "dynamics/tree/tree_kinematics.h"

namespace possibility::actions {
namespace {

constexpr double kUpright = 0.999;  // cosine of the axis's angle to the vertical
constexpr double kTrunk = 0.2;      // least share of the mass

/// kg, of each link with all that it carries.
std::vector<double> CarriedMasses(const models::RobotModel& robot) {
  std::vector<double> masses;
  for (const models::Link& link : robot.links) masses.push_back(link.inertial.mass);
  for (std::size_t joint = robot.joints.size(); joint-- > 0;) {
    masses[robot.joints[joint].parent] += masses[joint + 1];
  }
  return masses;
}

bool IsOfALimb(const models::Gait& gait, int joint) {
  return std::any_of(gait.limbs.begin(), gait.limbs.end(), [&](const models::GaitLimb& limb) {
    return std::find(limb.joints.begin(), limb.joints.end(), joint) != limb.joints.end();
  });
}

}  // namespace

std::optional<Waist> WaistJoint(const models::RobotModel& robot, const NominalStance& stance) {
  dynamics::TreeKinematics kinematics(robot);
  kinematics.SetPosition(stance.q);
  const std::vector<double> masses = CarriedMasses(robot);
  double greatest = kTrunk * masses.front();
  std::optional<Waist> waist;
  for (int joint = 0; joint < robot.num_joints(); ++joint) {
    const models::Joint& candidate = robot.joints[joint];
    const double up = (kinematics.X_WL()[joint + 1].linear() * candidate.axis).z();
    if (candidate.type == models::JointType::kPrismatic || candidate.mimic ||
        std::abs(up) < kUpright || masses[joint + 1] < greatest || IsOfALimb(*stance.gait, joint)) {
      continue;
    }
    greatest = masses[joint + 1];
    waist = Waist{joint, up > 0 ? 1.0 : -1.0};
  }
  return waist;
}

}  // namespace possibility::actions
