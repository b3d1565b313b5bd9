#pragma once

#include <Eigen/Core>
#include <vector>

#include "actions/plan/plan.h"
#include "models/robot/robot_model.h"

namespace possibility::experiments {

/// The order of links and joints in MuJoCo, and its coordinates: depth first, and the root's
/// position before its orientation and linear before angular velocity.
class MujocoTree {
 public:
  /// `robot` must outlive it.
  explicit MujocoTree(const models::RobotModel& robot);

  /// Links that hang on a link, in order.
  const std::vector<int>& children(int link) const { return children_[link]; }
  /// Joints in MuJoCo's order.
  const std::vector<int>& joints() const { return joints_; }
  /// Joints with a motor, in MuJoCo's order: those that mimic none.
  const std::vector<int>& motors() const { return motors_; }

  Eigen::VectorXd Positions(const Eigen::VectorXd& q) const;  ///< qpos, nq
  /// qvel or qacc, nv: MuJoCo has the root's angular velocity (and its derivative) in the root's
  /// own axes.
  Eigen::VectorXd Rates(const Eigen::VectorXd& q, const Eigen::VectorXd& v) const;
  /// By motor: a master also bears the torques of its mimics.
  Eigen::VectorXd Controls(const Eigen::VectorXd& tau) const;

 private:
  void Visit(int link);

  const models::RobotModel& robot_;
  std::vector<std::vector<int>> children_;
  std::vector<int> joints_;
  std::vector<int> motors_;
};

}  // namespace possibility::experiments
