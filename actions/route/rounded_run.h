#pragma once

#include <optional>
#include <vector>

#include "actions/gait/gait_motion.h"
#include "actions/plan/plan.h"
#include "actions/route/route.h"
#include "common/cancellation_token.h"
#include "models/world/collision.h"
#include "models/world/environment.h"
#include "models/world/ground_map.h"

namespace possibility::actions {

/// The world that a run must not hit, and stands on.
struct RunWorld {
  const models::Environment& environment;
  const models::CollisionChecker& checker;
  const models::GroundMap& ground;
};

/// The motion of FlowAlong with rounded bends: wide ones first, and narrower where it hits
/// something or a limb would not stand on the run's level. None if nothing is left to be rounded,
/// or if there is no such motion. It hits nothing.
/// @throws Cancelled.
std::optional<std::vector<std::vector<Phase>>> RoundedFlow(const LocomotionModel& model,
                                                           const RunWorld& world,
                                                           const Route& route, int first, int count,
                                                           const FlowEnd& end,
                                                           const CancellationToken& cancellation);

}  // namespace possibility::actions
