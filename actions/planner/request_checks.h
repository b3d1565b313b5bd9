#pragma once

#include <memory>
#include <string>
#include <vector>

#include "actions/conditions/locomotion_model.h"
#include "actions/conditions/manoeuvre.h"
#include "actions/conditions/quasi_static_action.h"
#include "models/robot/robot_model.h"
#include "models/world/scenario.h"

namespace possibility::actions {

/// Names of a request's gaits and manoeuvres.
std::vector<std::string> FurtherNames(const std::vector<GaitFactory>& gaits,
                                      const std::vector<ManoeuvreFactory>& manoeuvres);

/// @throws InputError if a gait or manoeuvre of the request has the name of another action, or a
/// name that no action may have.
void RequireNewNames(const models::RobotModel& robot, const models::Scenario& scenario,
                     const std::vector<GaitFactory>& gaits,
                     const std::vector<ManoeuvreFactory>& manoeuvres);

/// Start or goal as a stance of one of `gaits` (in the order of LocomotionModel::gaits). `key` in
/// the scenario's file and `names` of the planned actions are for messages.
/// @throws InputError unless C_S holds at the stance.
GroundedStance CheckedStance(const models::Stance& stance, const std::string& key,
                             const models::Scenario& scenario, const LocomotionModel& model,
                             const std::vector<std::shared_ptr<QuasiStaticAction>>& gaits,
                             const std::vector<std::string>& names);

}  // namespace possibility::actions
