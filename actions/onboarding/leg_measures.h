#pragma once

#include "actions/onboarding/robot_draft.h"

namespace possibility::actions {

/// Sets the length of the legs and the extents of the left sole from the robot, its legs and its
/// first two contacts. @throws InputError naming the file if the soles are not below the hips.
void MeasureLegs(RobotDraft* draft);

}  // namespace possibility::actions
