#pragma once

#include <set>
#include <string>

#include "models/robot/robot_model.h"
#include "models/robot/urdf_reader.h"

namespace possibility::models {

/// Fills in `mimic` of the robot's joints from the URDF's `<mimic>` elements. Call after
/// BuildLumpedTree. A mimic of a mimic follows the last master of the chain. The effort limit of a
/// mimic becomes infinite. A lumped joint is held at 0 whether or not it mimics another joint.
/// @throws InputError naming `file` and the joint if the master is unknown, fixed or lumped, joints
/// mimic each other in a circle, the multiplier is 0 (below 1e-6 in magnitude; along a chain, too),
/// or no interval of the master's positions lies within all limits.
void CoupleMimicJoints(const UrdfTree& tree, const std::set<std::string>& lumped,
                       const std::string& file, RobotModel* robot);

/// Sets the mimic joints in `joints` (num_joints) to the values that follow from their masters.
void FollowMasters(const RobotModel& robot, Eigen::VectorXd* joints);

/// What the motors bear, num_joints: torques `tau` of mimic joints are added to their masters' and
/// set to 0.
Eigen::VectorXd MotorTorques(const RobotModel& robot, const Eigen::VectorXd& tau);

}  // namespace possibility::models
