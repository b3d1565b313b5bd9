#pragma once

#include "actions/gait/swept_volume.h"
#include "actions/transition/transition_motion.h"
#include "models/robot/robot_model.h"

namespace possibility::actions {

/// Volume swept by a transition, in the first gait's stance frame.
SweptVolume SweepTransition(const models::RobotModel& robot, const TransitionMotion& transition);

}  // namespace possibility::actions
