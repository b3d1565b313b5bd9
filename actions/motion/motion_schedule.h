#pragma once

#include <vector>

#include "actions/plan/plan.h"
#include "models/robot/contact_schedule.h"
#include "models/robot/robot_model.h"

namespace possibility::actions {

/// The contact schedule that a motion follows: an interval for every stretch with the same
/// contacts, with their poses where it begins. Contacts in the order in which they first bear.
/// `segments`: contiguous in time, each phase with knots of the robot's sizes. @throws InputError
/// if a contact is not the robot's.
models::ContactSchedule ScheduleOfMotion(const models::RobotModel& robot,
                                         const std::vector<Segment>& segments);

}  // namespace possibility::actions
