#pragma once

#include "actions/wholebody/nominal_stance.h"
#include "models/robot/robot_model.h"

namespace possibility::actions {

/// How hard it is for a robot to stand on one leg: the torque with which the joint that rolls a hip
/// holds up the rest of the robot, sideways, in the nominal posture, as a share of the joint's
/// limit; the largest of all limbs. 0 if no limb has such a joint.
double SidewaysLoad(const models::RobotModel& robot, const NominalStance& stance);

}  // namespace possibility::actions
