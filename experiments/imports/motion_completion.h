#pragma once

#include <vector>

#include "actions/plan/plan.h"
#include "experiments/imports/contact_phases.h"
#include "experiments/imports/imported_trajectory.h"
#include "models/robot/robot_model.h"
#include "models/world/ground_map.h"

namespace possibility::experiments {

/// Segments of a plan that follow an imported motion (docs/exports.md, "Import"). Velocities and
/// accelerations that the file does not have are differences of its samples, changed as little as
/// the contacts demand; torques and forces follow from the motion. The verifier decides whether
/// the robot can do it.
///
/// `actions`: by segment.
/// @throws InputError naming the file and the time if the motion is beyond all numbers of plans.
std::vector<actions::Segment> CompleteMotion(const ImportedTrajectory& trajectory,
                                             const std::vector<std::string>& actions,
                                             const models::RobotModel& robot,
                                             const models::GroundMap& ground);

}  // namespace possibility::experiments
