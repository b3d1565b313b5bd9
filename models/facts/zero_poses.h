#pragma once

#include <Eigen/Geometry>
#include <map>
#include <string>
#include <vector>

#include "models/robot/robot_model.h"
#include "models/robot/urdf_reader.h"

namespace possibility::models {

/// Pose of every link of a URDF in its root, all joints at 0.
std::map<std::string, Eigen::Isometry3d> ZeroPoses(const UrdfTree& tree);

/// Pose of every link of a robot in its root. `joints`: num_joints, rad or m.
std::vector<Eigen::Isometry3d> PosesInRoot(const RobotModel& robot, const Eigen::VectorXd& joints);

}  // namespace possibility::models
