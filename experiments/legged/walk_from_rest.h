#pragma once

#include <memory>

#include "collocation/problem/optimal_control_problem.h"
#include "models/robot/robot_model.h"

namespace possibility::experiments {

struct WalkFromRestSettings {
  double distance = 0.8;      ///< m, ahead
  double longest_step = 0.4;  ///< m, from one stance of a foot's to the other foot's next one
};

/// A walk of a humanoid in space from rest to rest, double and single supports in turn, with free
/// durations (actions::StateSpatialProblem). Legs and swinging arms move. Nothing keeps the legs
/// apart. `humanoid`: with a gait "walk" on its two soles.
std::unique_ptr<collocation::OptimalControlProblem> WalkFromRest(
    const models::RobotModel& humanoid, const WalkFromRestSettings& settings = {});

}  // namespace possibility::experiments
