#include "models/robot/rotors.h"

#include <algorithm>

namespace possibility::models {

bool HasRotors(const RobotModel& robot) {
  return std::any_of(robot.joints.begin(), robot.joints.end(),
                     [](const Joint& joint) { return joint.actuator.armature > 0; });
}

}  // namespace possibility::models
