#pragma once

#include <string>
#include <vector>

#include "actions/jump_model.h"
#include "actions/jump_problem.h"
#include "actions/plan.h"

namespace possibility::actions {

/// What the verifier finds wrong with a motion of `task` from stance to stance in a world of
/// nothing but two floors, at the heights of launch and landing: wrong there, wrong anywhere. Empty
/// if nothing. `phases`: in the launch stance's frame. Their simulation is left to the verification
/// of plans.
std::string FaultOnBareGround(const models::RobotModel& robot, const JumpModel& model,
                              const NominalStance& launch, const NominalStance& landing,
                              const JumpTask& task, const std::vector<Phase>& phases,
                              bool simulates = false);

}  // namespace possibility::actions
