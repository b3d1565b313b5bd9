#pragma once

#include <functional>
#include <string>
#include <vector>

#include "actions/gait/dynamic_gait.h"
#include "actions/onboarding/robot_draft.h"
#include "actions/onboarding/standing_posture.h"
#include "common/cancellation_token.h"

namespace possibility::actions {

/// What was tried, and what became of it.
struct FitTrial {
  StandingChoice choice;
  double quickness = 1;
  double margin = 1;    ///< of ScaledParameters' com_margin
  double sway = 0;      ///< rad, GaitParameters
  double speed = 0;     ///< m/s, of the quickest pace that fits, or of quasi-static strides
  std::string reason;   ///< why there is no walk; empty otherwise
  std::string binding;  ///< what forbids a quicker pace
};

/// In one line.
std::string TextOf(const FitTrial& trial);

/// A gait on two feet whose strides and paces the robot can make.
struct FittedGait {
  models::Gait gait;
  std::vector<IgnoredPair> ignored;  ///< for its posture
  std::vector<Pace> paces;
  StandingPosture standing;
  FitTrial trial;
};

/// Searches the distance of the feet, the posture's height, the margin of balance and the time of
/// swings, one after the other, for the quickest walk. Stops after `seconds`, or when the walk is
/// as quick as ExpectedSpeed times `enough`. Only if nothing walks, the trunk sways. None if no
/// trial gives a walk at all; the trials say why. `progress`: called after each trial.
std::vector<FittedGait> FitWalk(const RobotDraft& draft, double seconds, double enough,
                                std::vector<FitTrial>* trials,
                                const std::function<void(const FitTrial&)>& progress);

}  // namespace possibility::actions
