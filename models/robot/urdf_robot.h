#pragma once

#include <filesystem>
#include <set>
#include <string>

#include "models/robot/lumping.h"
#include "models/robot/robot_model.h"
#include "models/robot/urdf_reader.h"

namespace possibility::models {

/// What a URDF alone says of a robot.
struct UrdfRobot {
  RobotModel robot;  ///< links and joints; limits as written, whether or not they are positive
  PendingMeshes meshes;
};

/// Lumps and couples the links and joints of a tree. `lumped`: names of joints held at 0.
/// @throws InputError as BuildLumpedTree and CoupleMimicJoints, and if no joint is left.
UrdfRobot BuildUrdfRobot(const UrdfTree& tree, const std::set<std::string>& lumped,
                         const std::filesystem::path& urdf_file);

}  // namespace possibility::models
