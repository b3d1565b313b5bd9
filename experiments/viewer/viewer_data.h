#pragma once

#include <string>
#include <utility>
#include <vector>

#include "actions/plan/plan.h"
#include "models/robot/robot_model.h"
#include "models/world/scenario.h"

namespace possibility::experiments {

/// Title and facts of a page.
struct PageHeading {
  std::string title;
  std::vector<std::pair<std::string, std::string>> facts;  ///< in the order shown
  bool plots_first = false;  ///< whether the page opens with its plots
};

/// The heading of a plan's page.
PageHeading HeadingOf(const actions::Plan& plan, const models::RobotModel& robot,
                      const models::Scenario& scenario);

/// Data for experiments/viewer/*.js, as JSON that is safe inside a <script> element: joint tree
/// with limits, shapes, what is seen of the robot (LookOf), phases with names, knots no closer than
/// a video's frames (5 ms in jumps), forces, impulses, centre of mass, momenta, balance, margins,
/// joint rates and torques, explored graph. Long lists of numbers are base64, and each distinct
/// course of a number through a phase is stored once (viewer_packing.h).
/// @throws InputError if the plan names a contact that the robot does not have.
std::string ViewerDataJson(const actions::Plan& plan, const models::RobotModel& robot,
                           const models::Scenario& scenario, const PageHeading& heading);

}  // namespace possibility::experiments
