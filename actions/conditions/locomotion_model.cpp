#include "actions/conditions/locomotion_model.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "actions/conditions/exploration_pose.h"
#include "actions/transition/transition_volume.h"
#include "models/world/scenario.h"

namespace possibility::actions {
namespace {

bool IsJump(const models::RobotModel& robot, const std::string& action) {
  return std::any_of(robot.jumps.begin(), robot.jumps.end(),
                     [&](const models::Jump& jump) { return jump.name == action; });
}

}  // namespace

int LocomotionModel::GaitIndex(const std::string& name) const {
  for (size_t i = 0; i < gaits.size(); ++i) {
    if (gaits[i]->stance.gait->name == name) return static_cast<int>(i);
  }
  return -1;
}

LocomotionModel BuildLocomotionModel(const models::RobotModel& robot,
                                     const std::vector<std::string>& actions,
                                     const std::function<bool()>& keep_going,
                                     const std::filesystem::path& library) {
  models::CheckActionsOfRobot(actions, robot, robot.file.string());
  LocomotionModel model;
  model.robot = &robot;
  for (const std::string& action : actions) {
    if (IsJump(robot, action)) continue;
    auto entry = std::make_unique<LocomotionModel::GaitEntry>();
    entry->stance = SolveNominalStance(robot, robot.GaitNamed(action));
    entry->motion = std::make_unique<GaitMotion>(robot, entry->stance);
    entry->volumes = SweepGait(robot, entry->stance, keep_going);
    model.gaits.push_back(std::move(entry));
  }
  for (const models::Transition& transition : robot.transitions) {
    LocomotionModel::TransitionEntry entry;
    entry.from = model.GaitIndex(transition.from);
    entry.to = model.GaitIndex(transition.to);
    if (entry.from < 0 || entry.to < 0) continue;
    entry.motion = std::make_unique<TransitionMotion>(
        robot, model.gaits[entry.from]->stance, model.gaits[entry.to]->stance, library, keep_going);
    entry.sweep = SweepTransition(robot, *entry.motion).Boxes();
    model.transitions.push_back(std::move(entry));
  }
  return model;
}

double ChainLength(const models::RobotModel& robot, const models::ContactPatch& patch) {
  double length = 0;
  for (const Eigen::Vector3d& p : patch.points) length = std::max(length, p.norm());
  for (int link = patch.link; link != 0; link = robot.joints[link - 1].parent) {
    const models::Joint& joint = robot.joints[link - 1];
    length += joint.X_PJ.translation().norm();
    if (joint.type == models::JointType::kPrismatic) {
      length += std::max(std::abs(joint.lower), std::abs(joint.upper));
    }
  }
  return length;
}

double BearingReach(const models::RobotModel& robot, const models::Gait& gait) {
  double reach = 0;
  for (const models::GaitLimb& limb : gait.limbs) {
    reach = std::max(reach, ChainLength(robot, robot.contacts[limb.contact]));
  }
  return reach;
}

[[gnu::hot]] std::optional<GroundedStance> AsStance(const LocomotionModel& model, int gait,
                                                    const Eigen::Isometry3d& X_WR) {
  constexpr double kTiltTolerance = 1e-6;
  const Eigen::Isometry3d& X_SR = model.gaits[gait]->stance.X_SR;
  const Eigen::Matrix3d R_WS = X_WR.linear() * X_SR.linear().transpose();
  if ((R_WS.col(2) - Eigen::Vector3d::UnitZ()).norm() > kTiltTolerance) return std::nullopt;
  GroundedStance stance;
  stance.gait = gait;
  const double yaw = std::atan2(R_WS(1, 0), R_WS(0, 0));
  const Eigen::Vector3d origin = X_WR.translation() - R_WS * X_SR.translation();
  stance.pose = {origin.x(), origin.y(), yaw};
  stance.z = origin.z();
  return stance;
}

}  // namespace possibility::actions
