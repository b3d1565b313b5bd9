#pragma once

#include <filesystem>
#include <string>

#include "models/robot/robot_model.h"

namespace possibility::experiments {

struct WindingWays {
  int tried = 0;
  int verified = 0;
  std::string refusal;  ///< one line on the first way that is not verified; empty if all are

  bool AllVerified() const { return verified == tried; }
};

/// Turns eight winding ways on a level floor, always the same, into motion by a gait, and verifies
/// it: each of eight legs ahead or back, aside and with turns. C_S accepts all of them, so a plan
/// may take any. A walk straight ahead shows neither what turns need nor what grows from step to
/// step. `library`: of paces. `scale`: m, of the leg.
/// @throws InputError if the robot cannot execute the gait's strides.
WindingWays WalkWindingWays(const models::RobotModel& robot, const std::string& gait,
                            const std::filesystem::path& library, double scale);

}  // namespace possibility::experiments
