#pragma once

#include "actions/plan/packed_phase.h"
#include "actions/plan/plan.h"
#include "models/robot/robot_model.h"

namespace possibility::actions {

/// Sets tau in all knots that have none, as it is between knots (docs/file_formats.md, "Meaning
/// between knots"): inverse dynamics minus the contact forces, changed as little as the root's rows
/// need. Phases that do not fit the robot stay as they are, for the verifier to report.
void CompleteTorques(const models::RobotModel& robot, Plan* plan);

/// Left out, if the plan is of version 2 and every tau is what CompleteTorques would set, to the
/// step of torques in a file; else stored. So nothing is lost with them.
PackedTorques TorquesToPack(const models::RobotModel& robot, const Plan& plan);

}  // namespace possibility::actions
