#pragma once

#include <vector>

#include "actions/wholebody/motion_builder.h"
#include "collocation/robot/multibody_functions.h"
#include "collocation/transcription/trajectory.h"
#include "models/robot/contact_schedule.h"
#include "models/robot/robot_model.h"

namespace possibility::actions {

/// The solved motion of a contact schedule (StateSpatialProblem) as tasks for MotionBuilder. Root
/// and free joints move as planned. A limb that bears is where the schedule has its contact, to the
/// last digit; a limb that swings moves as planned, and what is missing at its ends, of the size of
/// the transcription's error, dies out during the swing.
/// `limbs`: of one gait, with a limb for each contact of the schedule. `trajectory`: a phase for
/// each interval. All but `model` must outlive the result.
/// @throws std::invalid_argument if a contact has no limb or sizes differ; MotionError if a contact
/// is out of reach.
std::vector<MotionPhase> SpatialMotion(const models::RobotModel& robot, const models::Gait& gait,
                                       const models::ContactSchedule& schedule,
                                       const collocation::RobotSystem& model,
                                       const collocation::Trajectory& trajectory);

}  // namespace possibility::actions
