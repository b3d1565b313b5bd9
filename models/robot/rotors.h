#pragma once

#include "models/robot/robot_model.h"

namespace possibility::models {

/// Whether the robot's file states the rotor of any joint's motor. Motions of such a robot are
/// meant for a machine: they are planned with reserves, for motors a tenth weaker, a body 5 %
/// heavier and ground tilted by 1 degree.
bool HasRotors(const RobotModel& robot);

}  // namespace possibility::models
