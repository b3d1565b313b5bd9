#pragma once

#include <string>

#include "actions/plan/plan.h"
#include "experiments/viewer/viewer_data.h"
#include "models/robot/robot_model.h"
#include "models/world/scenario.h"

namespace possibility::experiments {

/// One HTML file that draws and plays a plan in a browser and needs nothing else, neither other
/// files nor a network (docs/viewer.md). Names are escaped: they cannot end up as markup or code.
/// The sizes of the plan must be the robot's (RequireFit).
/// @throws InputError if the plan names a contact that the robot does not have.
std::string ViewerPage(const actions::Plan& plan, const models::RobotModel& robot,
                       const models::Scenario& scenario);
/// The same under a heading of its own.
std::string ViewerPage(const actions::Plan& plan, const models::RobotModel& robot,
                       const models::Scenario& scenario, const PageHeading& heading);

}  // namespace possibility::experiments
