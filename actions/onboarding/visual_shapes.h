#pragma once

#include <string>

#include "actions/onboarding/robot_draft.h"
#include "models/robot/urdf_robot.h"

namespace possibility::actions {

/// The draft's tree with the links' `<visual>` shapes and meshes in place of the collision ones.
/// @throws InputError as ParseUrdf.
models::UrdfTree VisualTree(const RobotDraft& draft);

/// If a foot has no collision shape, every link of `built` without any gets those that it shows,
/// with a warning. The URDF's `<visual>` elements are read only then.
/// @throws InputError as ParseUrdf.
void AddVisualShapes(RobotDraft* draft, models::UrdfRobot* built);

}  // namespace possibility::actions
