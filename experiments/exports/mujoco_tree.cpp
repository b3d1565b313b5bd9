#include "experiments/exports/mujoco_tree.h"

#include <Eigen/Geometry>

namespace possibility::experiments {

MujocoTree::MujocoTree(const models::RobotModel& robot)
    : robot_(robot), children_(robot.num_links()) {
  for (int j = 0; j < robot.num_joints(); ++j) children_[robot.joints[j].parent].push_back(j + 1);
  Visit(0);
  for (const int j : joints_) {
    if (!robot.joints[j].mimic) motors_.push_back(j);
  }
}

void MujocoTree::Visit(int link) {
  if (link > 0) joints_.push_back(link - 1);
  for (const int child : children_[link]) Visit(child);
}

Eigen::VectorXd MujocoTree::Positions(const Eigen::VectorXd& q) const {
  Eigen::VectorXd qpos(q.size());
  qpos.head<7>() << q.segment<3>(4), q.head<4>();
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    qpos[static_cast<Eigen::Index>(7 + i)] = q[7 + joints_[i]];
  }
  return qpos;
}

Eigen::VectorXd MujocoTree::Rates(const Eigen::VectorXd& q, const Eigen::VectorXd& v) const {
  const Eigen::Quaterniond orientation(q[0], q[1], q[2], q[3]);
  const Eigen::Vector3d angular = v.head<3>();
  Eigen::VectorXd rates(v.size());
  rates.head<6>() << v.segment<3>(3), orientation.normalized().conjugate() * angular;
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    rates[static_cast<Eigen::Index>(6 + i)] = v[6 + joints_[i]];
  }
  return rates;
}

Eigen::VectorXd MujocoTree::Controls(const Eigen::VectorXd& tau) const {
  Eigen::VectorXd borne = tau;
  for (int j = 0; j < robot_.num_joints(); ++j) {
    const auto& mimic = robot_.joints[j].mimic;
    if (mimic) borne[mimic->joint] += mimic->multiplier * tau[j];
  }
  Eigen::VectorXd controls(motors_.size());
  for (std::size_t i = 0; i < motors_.size(); ++i) {
    controls[static_cast<Eigen::Index>(i)] = borne[motors_[i]];
  }
  return controls;
}

}  // namespace possibility::experiments
