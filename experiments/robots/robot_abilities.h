#pragma once

#include <filesystem>
#include <vector>

#include "actions/onboarding/robot_report.h"
#include "models/robot/robot_model.h"

namespace possibility::experiments {

/// What a robot does in scenes of its own size, planned and verified: for each gait a walk of eight
/// lengths of the leg on a level floor, winding ways, one step up, three steps up and a crack; and
/// which kinds of action its file has not. Never a fault. Takes up to 20 s a scene. `library`: of
/// motions.
std::vector<actions::RobotFinding> AbilitiesOf(const models::RobotModel& robot,
                                               const std::filesystem::path& library);

}  // namespace possibility::experiments
