#pragma once

#include <string>

#include "actions/onboarding/robot_draft.h"

namespace possibility::actions {

/// Whether the robot looks along -x of its root: its feet extend more to the back than ahead of the
/// ankles, and its knees bend that way.
bool FacesBackward(const RobotDraft& draft);

/// The URDF with a new root, a frame without mass that is turned by half a turn about z. `root`:
/// the old one. @throws InputError if the text has no `</robot>`.
std::string WithTurnedRoot(const std::string& urdf, const std::string& root);

}  // namespace possibility::actions
