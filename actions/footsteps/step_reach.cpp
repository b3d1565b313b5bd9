#include "actions/footsteps/step_reach.h"

#include <algorithm>
#include <limits>

#include "actions/wholebody/support_polygon.h"

namespace possibility::actions {
namespace {

using Eigen::Vector2d;

/// Usable share of the straight limb.
constexpr double kUsableStretch = 0.97;

/// SupportPolygon::Nearest is that exact, m.
constexpr double kOfMargin = 1e-3;

}  // namespace

StepReach::StepReach(const models::RobotModel& robot, const NominalStance& stance)
    : stance_(stance), reaches_(ReachesOf(robot, stance, kUsableStretch)) {
  if (reaches_.size() == 2) root_over_ = {RootOver(0), RootOver(1)};
}

Vector2d StepReach::RootOver(int limb) const {
  const SupportPolygon patch(stance_.bearing_points[limb]);
  const Vector2d shift =
      patch.Nearest(stance_.centre_of_mass, stance_.gait->parameters.com_margin) -
      stance_.centre_of_mass;
  return Vector2d(stance_.X_SR.translation().head<2>()) + shift;
}

std::optional<double> StepReach::HighestOver(const PlanarPose& root, int limb,
                                             const Foothold& place) const {
  if (!reaches_[limb]) return std::numeric_limits<double>::infinity();
  const Vector2d centre = place.stance * Vector2d(stance_.patch_centres[limb].head<2>());
  return reaches_[limb]->HighestRoot(root, {centre.x(), centre.y(), place.z},
                                     FrameOf(stance_, limb, place).linear());
}

std::optional<double> StepReach::HighestOverOne(const std::vector<Foothold>& feet, int limb) const {
  const Foothold& place = feet[limb];
  const Foothold& other = feet[1 - limb];
  const Vector2d root = other.stance * root_over_[1 - limb];
  const double yaw = other.stance.yaw + WrapAngle(place.stance.yaw - other.stance.yaw) / 2;
  const auto highest = HighestOver({root.x(), root.y(), yaw}, limb, place);
  if (!highest) return std::nullopt;
  return *highest - other.z;
}

std::optional<double> StepReach::HighestOverMany(const std::vector<Foothold>& feet,
                                                 int limb) const {
  std::vector<Vector2d> points;
  for (int bearing = 0; bearing < static_cast<int>(feet.size()); ++bearing) {
    if (bearing == limb) continue;
    for (const Vector2d& p : stance_.bearing_points[bearing]) {
      points.push_back(feet[bearing].stance * p);
    }
  }
  const Foothold rest = RestOf(feet, limb);
  const Vector2d wanted = rest.stance * stance_.centre_of_mass;
  const SupportPolygon support(points);
  const double margin = stance_.gait->parameters.com_margin;
  const Vector2d centre = support.Nearest(wanted, margin);
  if (support.Margin(centre) < margin - kOfMargin) return std::nullopt;
  const Vector2d root =
      rest.stance * Vector2d(stance_.X_SR.translation().head<2>()) + centre - wanted;
  double least = std::numeric_limits<double>::infinity();
  for (int each = 0; each < static_cast<int>(feet.size()); ++each) {
    const auto highest = HighestOver({root.x(), root.y(), rest.stance.yaw}, each, feet[each]);
    if (!highest) return std::nullopt;
    least = std::min(least, *highest);
  }
  return least - rest.z;
}

std::optional<double> StepReach::HighestRoot(const std::vector<Foothold>& feet, int limb) const {
  return feet.size() == 2 ? HighestOverOne(feet, limb) : HighestOverMany(feet, limb);
}

}  // namespace possibility::actions
