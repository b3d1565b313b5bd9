#pragma once

#include "actions/onboarding/robot_draft.h"

namespace possibility::actions {

/// A robot of a YAML file as FitWalk takes it, with one of its gaits on two feet: its limits, pairs
/// of links and the joints outside the legs stay. `gait`: of the robot.
/// @throws InputError naming file and key unless the gait has two limbs with six joints each, left
/// and right, that hold their orientation, and an upright posture.
RobotDraft DraftToRefit(const models::RobotModel& robot, const models::Gait& gait);

}  // namespace possibility::actions
