#include "actions/motion_identity.h"

#include <fmt/format.h>

#include "models/file_contents.h"

namespace possibility::actions {
namespace {

// A field that is added to the settings belongs here.

std::string Words(const SagittalLimits& l) {
  return fmt::format("{} {} {} {} {} {} {} {} {}", l.friction, l.friction_fraction,
                     l.speed_fraction, l.torque_fraction, l.max_acceleration, l.max_base_speed,
                     l.min_normal_force, l.max_normal_force, l.joint_margin);
}

std::string SagittalWords(const SagittalSettings& s) {
  return fmt::format("{} {} {} {} {} {} {}", Words(s.limits), s.body_clearance, s.hand_clearance,
                     s.hand_approach, s.sole_margin, s.max_hand_tilt, s.arm_reach);
}

}  // namespace

std::string MotionIdentity(const models::RobotModel& robot, const JumpSettings& jump,
                           const SitDownSettings& sit_down) {
  return models::HashOfParts(
      {robot.content_hash, SagittalWords(jump),
       fmt::format("{} {} {} {}", jump.min_stance_pitch, jump.max_stance_pitch,
                   jump.max_contact_speed, jump.leg_reach),
       SagittalWords(sit_down),
       fmt::format("{} {} {} {}", sit_down.sit.lower, sit_down.sit.upper, sit_down.bear.lower,
                   sit_down.bear.upper)});
}

std::filesystem::path MotionFolder(const std::filesystem::path& library,
                                   const std::string& identity) {
  return library.empty() ? library : library / identity.substr(0, 16);
}

}  // namespace possibility::actions
