#include "models/facts/zero_poses.h"

namespace possibility::models {

std::map<std::string, Eigen::Isometry3d> ZeroPoses(const UrdfTree& tree) {
  std::multimap<std::string, const UrdfJoint*> below;
  for (const UrdfJoint& joint : tree.joints) below.emplace(joint.parent, &joint);
  std::map<std::string, Eigen::Isometry3d> X_RL = {{tree.root, Eigen::Isometry3d::Identity()}};
  std::vector<std::string> open = {tree.root};
  while (!open.empty()) {
    const std::string link = open.back();
    open.pop_back();
    const auto [begin, end] = below.equal_range(link);
    for (auto it = begin; it != end; ++it) {
      X_RL[it->second->child] = X_RL[link] * it->second->X_PJ;
      open.push_back(it->second->child);
    }
  }
  return X_RL;
}

std::vector<Eigen::Isometry3d> PosesInRoot(const RobotModel& robot, const Eigen::VectorXd& joints) {
  std::vector<Eigen::Isometry3d> X_RL(robot.links.size(), Eigen::Isometry3d::Identity());
  for (int i = 0; i < robot.num_joints(); ++i) {
    const Joint& joint = robot.joints[i];
    X_RL[i + 1] = X_RL[joint.parent] * joint.X_PJ;
    if (joint.type == JointType::kPrismatic) {
      X_RL[i + 1].translate(joints[i] * joint.axis);
    } else {
      X_RL[i + 1].rotate(Eigen::AngleAxisd(joints[i], joint.axis));
    }
  }
  return X_RL;
}

}  // namespace possibility::models
