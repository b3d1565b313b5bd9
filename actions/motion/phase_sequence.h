#pragma once

#include <vector>

#include "actions/motion/planar_pose.h"
#include "actions/plan/plan.h"

namespace possibility::actions {

/// Adds `offset` (s) to every knot.
void ShiftTime(double offset, std::vector<Phase>* phases);

/// Puts `phase`, whose times begin at 0, behind the others.
void Append(Phase phase, std::vector<Phase>* motion);

/// The phases as they are in a world in which the stance frame they are relative to stands at
/// `stance` on ground of height z.
std::vector<Phase> Placed(std::vector<Phase> phases, const PlanarPose& stance, double z);

}  // namespace possibility::actions
