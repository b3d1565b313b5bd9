#include "actions/footholds/step_ground.h"

#include <algorithm>
#include <cmath>

#include "actions/footholds/foothold_ground.h"

namespace possibility::actions {

std::vector<double> SquareHeadingsOf(const models::Environment& environment) {
  std::vector<double> headings;
  const auto add = [&headings](double yaw) {
    const double heading = WrapAngle(4 * yaw) / 4;
    const bool known = std::any_of(headings.begin(), headings.end(), [&](double other) {
      return std::abs(WrapAngle(4 * (heading - other))) < 4e-3;
    });
    if (!known) headings.push_back(heading);
  };
  for (const models::Obstacle& obstacle : environment.obstacles) {
    if (obstacle.surface < 0) add(std::atan2(obstacle.X_WO(1, 0), obstacle.X_WO(0, 0)));
  }
  for (const models::Surface& surface : environment.surfaces) {
    for (const double heading : surface.headings) add(heading);
  }
  return headings;
}

StepGround::StepGround(const LocomotionModel& model, int gait, const World& world,
                       const FootstepLimits& limits)
    : headings(SquareHeadingsOf(*world.environment)) {
  const NominalStance& stance = model.gaits[gait]->stance;
  if (!StandsOnTwoSoles(*stance.gait)) return;
  cells.emplace(stance, world, GentlePlanes(*model.robot, *world.ground), limits);
  room.emplace(*cells, stance, world, limits, first_heading(), kPatchGap);
}

}  // namespace possibility::actions
