#pragma once

#include <string>

#include "actions/jump/jump_solver.h"
#include "actions/motion/motion_collision.h"

namespace possibility::actions {

/// Name of what a jump hits in a world of only two floors, at the heights of launch and landing,
/// and therefore in any world; empty if nothing. `poses`: of the jump's phases.
std::string FirstHitOnBareGround(const models::RobotModel& robot, const SagittalModel& model,
                                 const SolvedJump& jump, const MotionPoses& poses);

}  // namespace possibility::actions
