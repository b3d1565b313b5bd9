#pragma once

#include <memory>

#include "collocation/problem/function.h"
#include "collocation/robot/multibody_functions.h"
#include "collocation/robot/placed_patch.h"

namespace possibility::collocation {

struct SwingShape {
  double begin = 0;      ///< share of the swing that has passed when the phase begins
  double end = 1;        ///< and when it ends
  double clearance = 0;  ///< m, half-way
};

/// Height of each point of a patch that swings from one place to another over what it must clear,
/// m. On its way a point clears a hill. If it comes to rest higher or lower, the hill stands on a
/// step, which is whole from 15 % of the horizontal way on (or until 15 % are left, downwards): an
/// edge may lie anywhere between. On the level, or straight up, hill and way go by time.
/// Inputs: q, and the share of the phase.
std::shared_ptr<Function> SwingClearance(const RobotSystem& model, const PlacedPatch& from,
                                         const PlacedPatch& to, const SwingShape& shape);

}  // namespace possibility::collocation
