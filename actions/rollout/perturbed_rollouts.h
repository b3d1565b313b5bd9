#pragma once

#include <functional>
#include <vector>

#include "actions/plan/plan.h"
#include "actions/rollout/dynamic_stretch.h"
#include "actions/rollout/perturbation.h"
#include "common/cancellation_token.h"
#include "models/robot/robot_model.h"
#include "models/world/scenario.h"

namespace possibility::actions {

/// A plan's dynamic stretches, simulated under one perturbation. Each begins as planned.
struct PerturbedRollout {
  Perturbation perturbation;
  std::vector<StretchRollout> stretches;  ///< in order

  bool survives() const;  ///< all stretches do
};

struct PerturbedRolloutsSettings {
  int threads = 1;  ///< the result does not depend on it
  CancellationToken cancellation;
  /// Called after every simulation, from any thread, one call at a time, with the number of
  /// simulations done and that of all. May be empty.
  std::function<void(int, int)> progress;
};

/// Simulates every dynamic stretch under every perturbation. `plan`: must fit the robot's sizes and
/// contacts, as a plan that the verifier accepts does.
/// @throws Cancelled
std::vector<PerturbedRollout> RollOutPerturbed(const Plan& plan, const models::RobotModel& robot,
                                               const models::Scenario& scenario,
                                               const std::vector<Perturbation>& perturbations,
                                               const PerturbedRolloutsSettings& settings = {});

}  // namespace possibility::actions
