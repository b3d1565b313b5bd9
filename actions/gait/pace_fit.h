#pragma once

#include <optional>
#include <vector>

#include "actions/gait/pace.h"
#include "actions/gait/pace_trial.h"
#include "actions/wholebody/nominal_stance.h"
#include "models/robot/robot_model.h"

namespace possibility::actions {

/// The paces of a gait, from quick to slow, out of a family of multiples of the gait's parameters:
/// the quickest that keeps the robot's limits (PaceTrial), and the quickest of at most 60 % of its
/// speed. Empty if none fits. Takes some seconds.
std::vector<Pace> FitPaces(const models::RobotModel& robot, const NominalStance& stance);

/// The pace with the longest steps aside and in turns that the robot can make at it; none if it
/// cannot make those of the gait's parameters.
std::optional<Pace> WithStepsAside(const PaceTrial& trial, const models::GaitParameters& parameters,
                                   Pace pace);

}  // namespace possibility::actions
