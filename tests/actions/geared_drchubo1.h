#pragma once

#include <string>

#include "tests/actions/drchubo1.h"

namespace possibility::actions {

/// The shipped robot with rotors of 0.3 kg m^2 at the joints of its legs.
inline const models::RobotModel& GearedDrcHubo1() {
  static const models::RobotModel geared = [] {
    models::RobotModel robot = DrcHubo1();
    for (const int joint : robot.LegJoints()) robot.joints[joint].actuator.armature = 0.3;
    robot.content_hash += " with rotors";
    return robot;
  }();
  return geared;
}

}  // namespace possibility::actions
