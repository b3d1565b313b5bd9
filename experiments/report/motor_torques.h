#pragma once

#include <Eigen/Core>

#include "models/robot/robot_model.h"

namespace possibility::experiments {

/// Required motor torques, num_joints. Torques of mimic joints are added to their masters' and set
/// to 0.
Eigen::VectorXd MotorTorques(const models::RobotModel& robot, const Eigen::VectorXd& tau);

}  // namespace possibility::experiments
