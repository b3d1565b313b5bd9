#pragma once

#include <string>

#include "actions/jump_solver.h"

namespace possibility::actions {

/// What the verifier finds wrong with a jump in a world of nothing but two floors, at the heights
/// of launch and landing: wrong there, wrong anywhere. Empty if nothing. The simulation of the
/// jump is left to the verification of plans.
std::string FaultOnBareGround(const models::RobotModel& robot, const JumpModel& model,
                              const NominalStance& launch, const NominalStance& landing,
                              const SolvedJump& jump);

}  // namespace possibility::actions
