#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "dynamics/rollout/hybrid_rollout.h"
#include "dynamics/rollout/robot_rollout.h"
#include "dynamics/rollout/rollout_dynamics.h"
#include "dynamics/rollout/rollout_events.h"
#include "dynamics/rollout/rollout_guards.h"
#include "dynamics/rollout/rollout_stance.h"

namespace possibility::dynamics {

/// The modes of a rollout, one per stance: flow, guards, and the stance that follows when they
/// fire. This object and the constructor's arguments must outlive the modes.
class RolloutModes {
 public:
  RolloutModes(RolloutDynamics* robot, const RobotRolloutSettings& settings, RolloutEvents* events,
               const RobotRollout* rollout)
      : robot_(robot), settings_(settings), events_(events), rollout_(rollout) {}

  std::shared_ptr<const HybridMode> Make(RolloutStance made);
  /// Forgets all modes made so far.
  void Clear() { stances_.clear(); }
  /// @throws std::invalid_argument for a segment of an unknown mode.
  const RolloutStance& StanceOf(const HybridSegment& segment) const;

 private:
  struct Changes;

  std::string Describe(const std::vector<int>& held) const;
  HybridTransition Reset(const HybridEvent& event, const std::shared_ptr<const HybridMode>& mode,
                         const RolloutGuards& guards);
  Changes ChangesBy(const HybridEvent& event, const RolloutGuards& guards);

  RolloutDynamics* robot_;
  RobotRolloutSettings settings_;
  RolloutEvents* events_;
  const RobotRollout* rollout_;
  std::vector<std::pair<const HybridMode*, std::shared_ptr<const RolloutStance>>> stances_;
};

}  // namespace possibility::dynamics
