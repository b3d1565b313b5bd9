#pragma once

#include <string>
#include <vector>

#include "actions/plan/plan.h"
#include "actions/sagittal/sagittal_model.h"
#include "actions/wholebody/motion_collision.h"
#include "models/world/environment.h"

namespace possibility::actions {

/// The ground that a motion from stance to stance needs at least: two floors, at the heights of
/// launch and landing, that end 1 mm beyond the contacts of the stances. `distance` and `height`:
/// of the landing stance's frame in the launch stance's, m. `farther`: m by which the landing
/// ground reaches towards the launch ground, where there is room between them.
models::Environment BareGround(const SagittalModel& model, double distance, double height,
                               double farther = 0);

/// Verifies a motion from stance to stance on its bare ground. `phases`: in the launch stance's
/// frame. A fault found here does not depend on the scene. Returns the first one found; empty if
/// there is none. On request the motion is simulated as well, several times at once: as it is
/// planned, and on compliant ground with a robot that is a little heavier and a little lighter than
/// planned. Where that falls over, it was about to. In simulations the landing ground reaches 1 cm
/// farther, because hands slide by millimetres.
std::string FaultOnBareGround(const models::RobotModel& robot, const SagittalModel& model,
                              const NominalStance& launch, const NominalStance& landing,
                              double distance, double height, const std::vector<Phase>& phases,
                              bool simulates = false);

}  // namespace possibility::actions
