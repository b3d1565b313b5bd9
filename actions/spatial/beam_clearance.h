#pragma once

#include <vector>

#include "collocation/robot/multibody_functions.h"
#include "collocation/robot/robot_phase.h"
#include "models/robot/contact_schedule.h"
#include "models/robot/robot_model.h"

namespace possibility::actions {

/// An obstacle across the x axis on ground of height 0: a box of any width.
struct Beam {
  double begin = 0;   ///< m, along x
  double end = 0;     ///< m
  double height = 0;  ///< m
};

/// Keeps the parts of every limb below its knee off the beam: at each knot there is a plane across
/// the way with the beam on one side and the part on the other. The solver turns the planes, from
/// upright before the beam over level above it to upright behind it. A limb without a knee is left
/// alone.
/// `model`: on joints, of `robot`. `phases`: by interval of the schedule. `clearance`: m.
/// @throws std::invalid_argument if a limb that has to keep off bears on the beam.
void KeepOffBeam(const Beam& beam, double clearance, const models::RobotModel& robot,
                 const models::Gait& limbs, const models::ContactSchedule& schedule,
                 const collocation::RobotSystem& model,
                 const std::vector<collocation::RobotPhase>& phases);

}  // namespace possibility::actions
