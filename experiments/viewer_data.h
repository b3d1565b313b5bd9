#pragma once

#include <string>

#include "actions/plan.h"
#include "models/robot_model.h"
#include "models/scenario.h"

namespace possibility::experiments {

/// What the page is called.
std::string ViewerTitle(const models::Scenario& scenario);

/// What experiments/viewer/*.js draw, as JSON that may stand inside a <script> element: joint tree,
/// shapes, knots no closer than a video's frames, forces, explored graph. Long lists of numbers
/// are base64 of little-endian 32-bit floats or integers.
/// @throws InputError if the plan names a contact that the robot does not have.
std::string ViewerDataJson(const actions::Plan& plan, const models::RobotModel& robot,
                           const models::Scenario& scenario);

}  // namespace possibility::experiments
