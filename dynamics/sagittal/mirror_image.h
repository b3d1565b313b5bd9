#pragma once

#include <Eigen/Core>
#include <vector>

#include "dynamics/tree/multibody_model.h"
#include "models/robot/robot_model.h"

namespace possibility::dynamics {

/// Configurations, velocities and accelerations of a robot on joints (Base::kJoints), mirrored at
/// the plane y = 0: x'[i] = sign[i] * x[source[i]].
struct MirrorImage {
  std::vector<int> source;
  Eigen::VectorXd sign;  ///< 1 or -1

  Eigen::VectorXd Of(const Eigen::Ref<const Eigen::VectorXd>& x) const;
};

/// `model`: MultibodyModel::OnJoints(robot). Signs follow from the joints' axes when all joints are
/// at 0. @throws InputError naming a joint whose axis is not the mirror image of its partner's, or
/// that has no partner and an axis neither in the plane nor across it, or whose partner is locked.
MirrorImage MirrorImageOf(const models::RobotModel& robot, const MultibodyModel& model);

}  // namespace possibility::dynamics
