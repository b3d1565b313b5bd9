#include "actions/footholds/footstep.h"

#include <algorithm>
#include <limits>

#include "actions/wholebody/limb_bend.h"

namespace possibility::actions {
namespace {

constexpr double kHighStep = 1.2;  // s
constexpr double kSecondsPerMetreLifted = 2;

}  // namespace

FootstepLimits FootstepLimits::Of(const models::RobotModel& robot, const NominalStance& stance) {
  FootstepLimits limits;
  double leg = std::numeric_limits<double>::infinity();
  for (const models::GaitLimb& limb : stance.gait->limbs) {
    if (const auto bend = BendOf(robot, limb)) leg = std::min(leg, bend->length);
  }
  if (!std::isfinite(leg)) leg = stance.gait->posture.root_height;
  limits.forward = 0.5 * leg;
  limits.lateral = 0.24 * leg;
  limits.rise = 0.25 * leg;
  limits.lift = 0.4 * leg;
  limits.clearance = 0.045 * leg;
  limits.lowest_root = stance.gait->posture.root_height - 0.1 * leg;
  return limits;
}

double ExpectedDuration(const Footstep& step) {
  const double height = step.lift + step.ChangeOfHeight();
  return height > 0 ? kHighStep + kSecondsPerMetreLifted * height : kLevelStep;
}

}  // namespace possibility::actions
