#pragma once

#include <vector>

#include "actions/plan/plan.h"
#include "actions/wholebody/planar_pose.h"

namespace possibility::actions {

/// Adds `offset` (s) to every knot.
void ShiftTime(double offset, std::vector<Phase>* phases);

/// Appends `phase`, whose times begin at 0.
void Append(Phase phase, std::vector<Phase>* motion);

/// The phases in the world frame, if the stance frame they are relative to is at `stance` on ground
/// of height z.
std::vector<Phase> Placed(std::vector<Phase> phases, const PlanarPose& stance, double z);

}  // namespace possibility::actions
