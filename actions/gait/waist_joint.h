#pragma once

#include <optional>

#include "actions/motion/pattern_motion.h"
#include "actions/wholebody/nominal_stance.h"
#include "models/robot/robot_model.h"

namespace possibility::actions {

/// The joint about the vertical that carries the trunk of a robot in a gait's posture: the one that
/// moves most of the mass, at least a fifth of the robot's, and belongs to no limb of the gait.
/// None if there is no such joint.
std::optional<Waist> WaistJoint(const models::RobotModel& robot, const NominalStance& stance);

}  // namespace possibility::actions
