#include "actions/planner/least_duration.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "actions/flood/least_way.h"

namespace possibility::actions {
namespace {

/// The middle of the pelvis in a stance at the origin, seen from above, m.
Eigen::Vector2d PelvisOf(const LocomotionModel& model, int gait) {
  return model.gaits[gait]->stance.RootPose({}, 0).translation().head<2>();
}

/// At most as if the gait went ahead, aside and turned at once, each as quickly as alone.
double SpeedOfGait(const LocomotionModel& model, int gait) {
  const LocomotionModel::GaitEntry& entry = *model.gaits[gait];
  const auto speed = [&](const PlanarPose& displacement, double way) {
    return way / entry.motion->DisplacementDuration(entry.stance.gait->parameters, displacement);
  };
  const double off_axis = PelvisOf(model, gait).norm();
  return std::hypot(speed({1, 0, 0}, 1), speed({0, 1, 0}, 1)) + speed({0, 0, 1}, off_axis);
}

double SpeedOfTransition(const LocomotionModel& model,
                         const LocomotionModel::TransitionEntry& transition) {
  const Eigen::Vector2d way =
      transition.displacement * PelvisOf(model, transition.to) - PelvisOf(model, transition.from);
  return way.norm() / transition.phases.back().knots.back().t;
}

/// None if some manoeuvre does not bound its flight: no place may then be called closed.
std::optional<std::vector<FlightBounds>> FlightsOf(const PlanningMeans& means) {
  std::vector<FlightBounds> flights;
  for (const auto& manoeuvre : means.manoeuvres) {
    const std::optional<FlightBounds> flight = manoeuvre->Bounds().flight;
    if (!flight) return std::nullopt;
    flights.push_back(*flight);
  }
  return flights;
}

double StraightWay(const LocomotionModel& model, const GroundedStance& start,
                   const std::vector<GroundedStance>& goals) {
  const auto pelvis = [&](const GroundedStance& stance) -> Eigen::Vector2d {
    return stance.pose * PelvisOf(model, stance.gait);
  };
  double least = std::numeric_limits<double>::infinity();
  for (const GroundedStance& goal : goals) {
    least = std::min(least, (pelvis(goal) - pelvis(start)).norm());
  }
  return least;
}

}  // namespace

double GreatestSpeed(const PlanningMeans& means) {
  double greatest = 0;
  for (int gait = 0; gait < static_cast<int>(means.model.gaits.size()); ++gait) {
    greatest = std::max(greatest, SpeedOfGait(means.model, gait));
  }
  for (const LocomotionModel::TransitionEntry& transition : means.model.transitions) {
    greatest = std::max(greatest, SpeedOfTransition(means.model, transition));
  }
  for (const auto& manoeuvre : means.manoeuvres) {
    greatest = std::max(greatest, manoeuvre->GreatestSpeed());
  }
  for (const auto& steps : means.steps) greatest = std::max(greatest, steps->GreatestSpeed());
  return greatest;
}

double LeastDuration(const PlanningMeans& means, const GroundedStance& start,
                     const std::vector<GroundedStance>& goals,
                     const CancellationToken& cancellation) {
  double way = StraightWay(means.model, start, goals);
  if (const auto flights = FlightsOf(means)) {
    const std::optional<double> least =
        LeastWay(means.model, means.world, start, goals, means.settings.flood_resolution, *flights,
                 cancellation);
    way = std::max(way, least.value_or(0));
  }
  return way / GreatestSpeed(means);
}

}  // namespace possibility::actions
