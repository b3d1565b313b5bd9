#include "actions/footholds/footstep.h"

#include <algorithm>
#include <limits>

#include "actions/wholebody/limb_bend.h"

namespace possibility::actions {
namespace {

constexpr double kHighStep = 1.2;  // s
constexpr double kSecondsPerMetreLifted = 2;

/// Of more than two limbs, which have all others beside them: shares of a limb's length, and rad.
constexpr double kAheadOfMany = 0.25;
constexpr double kAsideOfMany = 0.12;
constexpr double kTurnOfMany = 0.2;
/// How far the root may sink, as a share of a limb's length. Of two limbs: usually, and if there is
/// no other way; SA01, X1, R1 and AzureLoong take steps up only that way. A trunk that keeps its
/// pitch over more limbs is as low as its lower end needs.
constexpr double kUsualSquatOfTwo = 0.1;
constexpr double kSquatOfTwo = 0.2;
constexpr double kSquatOfMany = 0.25;

}  // namespace

bool StandsOnTwoSoles(const models::Gait& gait) {
  return gait.limbs.size() == 2 &&
         std::all_of(gait.limbs.begin(), gait.limbs.end(),
                     [](const models::GaitLimb& limb) { return limb.hold_orientation; });
}

PlanarPose MeanStance(const std::vector<Foothold>& feet) {
  PlanarPose mean = feet.front().stance;
  for (std::size_t i = 1; i < feet.size(); ++i) {
    mean = Interpolate(mean, feet[i].stance, 1.0 / static_cast<double>(i + 1));
  }
  return mean;
}

Foothold RestOf(const std::vector<Foothold>& feet, int limb) {
  if (feet.size() == 2) return feet[1 - limb];
  std::vector<Foothold> others = feet;
  others.erase(others.begin() + limb);
  Foothold rest;
  rest.stance = MeanStance(others);
  for (const Foothold& other : others) rest.z += other.z / static_cast<double>(others.size());
  return rest;
}

FootstepLimits FootstepLimits::Of(const models::RobotModel& robot, const NominalStance& stance) {
  FootstepLimits limits;
  double leg = std::numeric_limits<double>::infinity();
  for (const models::GaitLimb& limb : stance.gait->limbs) {
    if (const auto bend = BendOf(robot, limb)) leg = std::min(leg, bend->length);
  }
  if (!std::isfinite(leg)) leg = stance.gait->posture.root_height;
  const bool is_biped = stance.gait->limbs.size() == 2;
  limits.forward = (is_biped ? 0.5 : kAheadOfMany) * leg;
  limits.lateral = (is_biped ? 0.24 : kAsideOfMany) * leg;
  if (!is_biped) limits.turn = kTurnOfMany;
  limits.rise = 0.25 * leg;
  limits.lift = 0.4 * leg;
  limits.clearance = 0.045 * leg;
  const double upright = stance.gait->posture.root_height;
  limits.lowest_root = upright - (is_biped ? kSquatOfTwo : kSquatOfMany) * leg;
  limits.usual_root = is_biped ? upright - kUsualSquatOfTwo * leg : limits.lowest_root;
  return limits;
}

double ExpectedDuration(const Footstep& step) {
  const double height = step.lift + step.ChangeOfHeight();
  return height > 0 ? kHighStep + kSecondsPerMetreLifted * height : kLevelStep;
}

}  // namespace possibility::actions
