#pragma once

#include <string>

#include "actions/jump/jump_solver.h"
#include "actions/motion/motion_collision.h"

namespace possibility::actions {

/// What a jump hits in a world of nothing but two floors, at the heights of launch and landing, and
/// so anywhere; empty if nothing. `poses`: of the jump's phases.
std::string FirstHitOnBareGround(const models::RobotModel& robot, const SagittalModel& model,
                                 const SolvedJump& jump, const MotionPoses& poses);

}  // namespace possibility::actions
