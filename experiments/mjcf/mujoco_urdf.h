#pragma once

#include <mujoco/mujoco.h>

#include <map>
#include <string>

#include "experiments/mjcf/mjcf_robot.h"

namespace possibility::experiments {

/// The robot of a compiled model; see ReadMjcf.
/// @param efforts N m or N that joints bear, by name, besides the limits of their actuators.
/// @throws InputError, without the file's name.
MjcfRobot UrdfOfModel(const mjModel& model, const std::string& robot,
                      const std::map<std::string, double>& efforts);

}  // namespace possibility::experiments
