#include "actions/sagittal/motion_identity.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "models/input/file_contents.h"

namespace possibility::actions {
namespace {

/// Of SagittalModel; motions solved with another version's joint limits are stale.
constexpr double kModelVersion = 3;

// Every new field of the settings must be added here.

std::vector<double> Fields(const collocation::RobotLimits& l) {
  return {l.friction,         l.friction_fraction, l.speed_fraction,
          l.torque_fraction,  l.max_acceleration,  l.max_base_speed,
          l.min_normal_force, l.max_normal_force,  l.joint_margin};
}

std::vector<double> Fields(const SagittalSettings& s) {
  return {s.least_point_load, s.body_clearance, s.hand_clearance, s.hand_approach,
          s.sole_margin,      s.max_hand_tilt,  s.arm_reach};
}

}  // namespace

std::string MotionIdentity(const models::RobotModel& robot, const SagittalSettings& settings,
                           const std::vector<double>& own) {
  return models::HashOfParts({robot.content_hash, fmt::format("{}", kModelVersion),
                              fmt::format("{}", fmt::join(Fields(settings.limits), " ")),
                              fmt::format("{}", fmt::join(Fields(settings), " ")),
                              fmt::format("{}", fmt::join(own, " "))});
}

}  // namespace possibility::actions
