#pragma once

#include <memory>
#include <vector>

#include "actions/conditions/locomotion_model.h"
#include "actions/conditions/manoeuvre.h"
#include "actions/footsteps/planned_steps.h"
#include "common/cancellation_token.h"
#include "models/world/scenario.h"

namespace possibility::actions {

/// What a planner may make plans of.
struct PlanningMeans {
  const LocomotionModel& model;
  const World& world;
  const std::vector<std::shared_ptr<Manoeuvre>>& manoeuvres;
  const std::vector<std::shared_ptr<PlannedSteps>>& steps;
  const models::PlannerSettings& settings;
};

/// Greatest mean speed of the middle of the pelvis over the ground from one end of a leg to the
/// other, seen from above, m/s: of straight ways at the quickest pace of each gait, turns included;
/// of transitions; of manoeuvres as far as their motions are known (Manoeuvre::GreatestSpeed).
double GreatestSpeed(const PlanningMeans& means);

/// Lower bound of the duration of every plan made of these means, s: LeastWay at GreatestSpeed.
/// Starting, stopping and turning count for nothing. 0 if the speed of a manoeuvre is not known.
double LeastDuration(const PlanningMeans& means, const GroundedStance& start,
                     const std::vector<GroundedStance>& goals,
                     const CancellationToken& cancellation);

}  // namespace possibility::actions
