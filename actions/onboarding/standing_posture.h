#pragma once

#include <optional>
#include <string>

#include "actions/onboarding/robot_draft.h"

namespace possibility::actions {

/// What a standing posture is free to choose.
struct StandingChoice {
  double extension = 0.9;  ///< height of the hips above the soles, of the leg's length at zero
  /// Distance of the soles, of their distance at zero; a gap of 0.07 of the leg's length stays.
  double spread = 1;
};

/// A symmetric posture on two feet.
struct StandingPosture {
  models::Posture posture;
  double torque = 0;         ///< greatest share of a torque limit, all the weight on one foot
  std::string torque_joint;  ///< the joint that has it
  double sole_distance = 0;  ///< m, between the soles' centres
};

/// The posture with the soles level below the hips and the centre of mass above the ankles, or as
/// near as keeps it 0.3 of the soles' length from heels and toes. None if the legs do not reach, by
/// `reason`.
std::optional<StandingPosture> StandWith(const RobotDraft& draft, const StandingChoice& choice,
                                         std::string* reason);

}  // namespace possibility::actions
