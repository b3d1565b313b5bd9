#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "actions/onboarding/robot_draft.h"
#include "models/robot/urdf_robot.h"

namespace possibility::actions {

/// Lumps and couples the draft's tree. If it holds inertias that no body has, those links get the
/// inertia of their shapes' hull, solid and homogeneous, at the mass and the centre of mass that
/// the URDF gives, with a warning; links without collision shapes that of what they show.
/// `packages`: see models::ResolveMeshPath.
/// @throws InputError as BuildUrdfRobot where there is no mass or no shape either.
models::UrdfRobot BuildWithAssumedInertials(const std::vector<std::filesystem::path>& packages,
                                            RobotDraft* draft);

}  // namespace possibility::actions
