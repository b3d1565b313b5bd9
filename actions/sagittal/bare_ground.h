#pragma once

#include <string>
#include <vector>

#include "actions/plan/plan.h"
#include "actions/sagittal/sagittal_model.h"

namespace possibility::actions {

/// Verifies a motion from stance to stance in a world of two floors, at the heights of launch and
/// landing. `distance` and `height`: of the landing stance's frame in the launch stance's, m.
/// `phases`: in the launch stance's frame. Simulates them only on request. A fault found here does
/// not depend on the scene. Returns the worst one; empty if there is none.
std::string FaultOnBareGround(const models::RobotModel& robot, const SagittalModel& model,
                              const NominalStance& launch, const NominalStance& landing,
                              double distance, double height, const std::vector<Phase>& phases,
                              bool simulates = false);

}  // namespace possibility::actions
