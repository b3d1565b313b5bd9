#pragma once

#include <string>
#include <vector>

#include "actions/sagittal/sagittal_problem.h"
#include "models/robot/robot_model.h"

namespace possibility::actions {

/// Hash of everything that solved motions depend on: the robot, the settings of the problem, and
/// `own`, the settings that a kind of motion adds. Solutions with another identity are stale.
std::string MotionIdentity(const models::RobotModel& robot, const SagittalSettings& settings,
                           const std::vector<double>& own);

}  // namespace possibility::actions
