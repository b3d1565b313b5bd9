#include "models/robot/urdf_robot.h"

#include "models/input/input_error.h"
#include "models/robot/mimic_joints.h"

namespace possibility::models {

UrdfRobot BuildUrdfRobot(const UrdfTree& tree, const std::set<std::string>& lumped,
                         const std::filesystem::path& urdf_file) {
  UrdfRobot built;
  built.meshes = BuildLumpedTree(tree, lumped, urdf_file.string(), &built.robot);
  CoupleMimicJoints(tree, lumped, urdf_file.string(), &built.robot);
  if (built.robot.joints.empty()) {
    throw InputError(urdf_file.string() + ": expected at least one joint");
  }
  return built;
}

}  // namespace possibility::models
