#pragma once

#include <string>
#include <vector>

#include "actions/plan/plan.h"
#include "models/robot/robot_model.h"

namespace possibility::experiments {

/// Names of a segment's phases, by their bearing contacts.
///
/// If the robot flies in it: "preparation" and "crouch" (the last before the toes or the flight),
/// "toes" (parts of patches alone), "flight", "settle" (what touched down), "landing" (more than
/// that). Otherwise: "stance" (all that ever bears in the segment), "swing PATCH" (all but one), or
/// "on PATCH, PATCH".
/// @throws InputError if a contact is not the robot's.
std::vector<std::string> PhaseNames(const models::RobotModel& robot,
                                    const actions::Segment& segment);

}  // namespace possibility::experiments
