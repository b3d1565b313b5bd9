#include "actions/footsteps/step_reach.h"

#include <algorithm>
#include <limits>

#include "actions/wholebody/support_polygon.h"

namespace possibility::actions {
namespace {

using Eigen::Vector2d;

/// Usable share of the straight limb.
constexpr double kUsableStretch = 0.97;

}  // namespace

StepReach::StepReach(const models::RobotModel& robot, const NominalStance& stance)
    : stance_(stance),
      reaches_(ReachesOf(robot, stance, kUsableStretch)),
      root_over_({RootOver(0), RootOver(1)}) {}

Vector2d StepReach::RootOver(int limb) const {
  const SupportPolygon patch(stance_.bearing_points[limb]);
  const Vector2d shift =
      patch.Nearest(stance_.centre_of_mass, stance_.gait->parameters.com_margin) -
      stance_.centre_of_mass;
  return Vector2d(stance_.X_SR.translation().head<2>()) + shift;
}

std::optional<double> StepReach::HighestRoot(int limb, const Foothold& place,
                                             const Foothold& other) const {
  if (!reaches_[limb]) return std::numeric_limits<double>::infinity();
  const Vector2d root = other.stance * root_over_[1 - limb];
  const double yaw = other.stance.yaw + WrapAngle(place.stance.yaw - other.stance.yaw) / 2;
  const Vector2d centre = place.stance * Vector2d(stance_.patch_centres[limb].head<2>());
  const auto highest =
      reaches_[limb]->HighestRoot({root.x(), root.y(), yaw}, {centre.x(), centre.y(), place.z},
                                  FrameOf(stance_, limb, place).linear());
  if (!highest) return std::nullopt;
  return *highest - other.z;
}

std::optional<double> StepReach::HighestRoot(const Footstep& step, const Foothold& other) const {
  const auto from = HighestRoot(step.limb, step.from, other);
  const auto to = HighestRoot(step.limb, step.to, other);
  if (!from || !to) return std::nullopt;
  return std::min(*from, *to);
}

}  // namespace possibility::actions
