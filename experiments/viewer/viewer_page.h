#pragma once

#include <string>

#include "actions/plan/plan.h"
#include "experiments/viewer/viewer_data.h"
#include "models/robot/robot_model.h"
#include "models/world/scenario.h"

namespace possibility::experiments {

/// What a page shows.
struct PageSubject {
  const actions::Plan& plan;
  const models::RobotModel& robot;
  const models::Scenario& scenario;
};

/// One self-contained HTML file that draws and plays a plan in a browser without other files or a
/// network (docs/viewer.md). Names are escaped, so they cannot act as markup or code. The sizes of
/// the plan must fit the robot (RequireFit).
/// @throws InputError if the plan names a contact that the robot does not have.
std::string ViewerPage(const actions::Plan& plan, const models::RobotModel& robot,
                       const models::Scenario& scenario);
/// A page that plays two plans side by side at the same time. The robots may differ.
/// @throws InputError likewise.
std::string ComparisonPage(const PageSubject& left, const PageSubject& right);
/// ViewerPage with the given heading.
std::string ViewerPage(const actions::Plan& plan, const models::RobotModel& robot,
                       const models::Scenario& scenario, const PageHeading& heading);

}  // namespace possibility::experiments
