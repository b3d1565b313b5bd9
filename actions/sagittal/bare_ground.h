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
/// of the landing stance's frame in the launch stance's, m.
models::Environment BareGround(const SagittalModel& model, double distance, double height);

/// Verifies a motion from stance to stance on its bare ground. `phases`: in the launch stance's
/// frame. Simulates them only on request. A fault found here does not depend on the scene. Returns
/// the worst one; empty if there is none.
std::string FaultOnBareGround(const models::RobotModel& robot, const SagittalModel& model,
                              const NominalStance& launch, const NominalStance& landing,
                              double distance, double height, const std::vector<Phase>& phases,
                              bool simulates = false);

/// Simulates such a motion on its bare ground, which is compliant, with a robot that is a little
/// heavier and a little lighter than planned. Where it falls over, it was about to. Returns how;
/// empty if it does not.
std::string FallOnBareGround(const models::RobotModel& robot, const SagittalModel& model,
                             const NominalStance& launch, const NominalStance& landing,
                             double distance, double height, const std::vector<Phase>& phases);

}  // namespace possibility::actions
