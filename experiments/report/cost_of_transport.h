#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "actions/plan/plan.h"
#include "models/robot/robot_model.h"

namespace possibility::experiments {

/// Mechanical work of the motors over a segment, J: the integral over time of the sum over all
/// motors of |torque * rate|. The work of braking counts like that of driving, as if nothing were
/// regained. Power is taken as linear between knots.
double MotorWork(const models::RobotModel& robot, const actions::Segment& segment);

/// Mechanical cost of transport of a plan (Collins, Ruina, Tedrake and Wisse 2005, who count
/// positive work alone): MotorWork / (m g length), with PlanarLength and no unit. None if the plan
/// leads nowhere.
std::optional<double> CostOfTransport(const models::RobotModel& robot, const actions::Plan& plan);

/// The same by action, for those of WaysByAction.
std::vector<std::pair<std::string, double>> CostsOfTransportByAction(
    const models::RobotModel& robot, const actions::Plan& plan);

}  // namespace possibility::experiments
