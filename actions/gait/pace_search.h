#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "actions/gait/pace.h"
#include "actions/wholebody/nominal_stance.h"
#include "common/cancellation_token.h"
#include "models/robot/robot_model.h"

namespace possibility::actions {

struct PaceSearchSettings {
  int trials = 4000;      ///< of each search, at most
  int idle_trials = 600;  ///< a search ends when so many have not made the pace quicker
  std::vector<std::uint32_t> seeds = {1, 2, 3, 4};  ///< of the searches; the quickest pace counts
  /// Told the speed that a search has reached, m/s, and how many trials were made of how many.
  std::function<void(double speed, int done, int all)> progress = {};
};

/// Optimises a pace: timing of its steps, height of the root and style, for the greatest mean speed
/// of a straight way from rest to rest at which trials keep the robot's limits (PaceTrial). An
/// evolution strategy with one parent and one child (Rechenberg 1973): the child differs in a few
/// numbers and takes the parent's place if it needs less of the limits; whenever they are kept, the
/// speed rises. Steps aside and in turns stay as long as those of `start`, or become longer. The
/// same seeds give the same pace.
/// `stance`: of a gait whose limbs swing in two groups. `start`: one that fits. None if no quicker
/// one was found.
/// @throws Cancelled.
std::optional<Pace> SearchPace(const models::RobotModel& robot, const NominalStance& stance,
                               const Pace& start, const PaceSearchSettings& settings = {},
                               const CancellationToken& cancellation = {});

/// The fitted paces, for gaits whose limbs swing in two groups with an optimised one before them if
/// there is one. Takes a minute or two.
std::vector<Pace> OptimisedPaces(const models::RobotModel& robot, const NominalStance& stance,
                                 const PaceSearchSettings& settings = {},
                                 const CancellationToken& cancellation = {});

}  // namespace possibility::actions
