#pragma once

#include "models/robot/robot_model.h"

namespace possibility::dynamics {

/// Joints that carry the root of a robot on a fixed world, from the world outwards: x, y, z, yaw,
/// roll, pitch. Singular at a roll of 90 degrees only; heading and pitch are free.
inline constexpr int kNumBaseJoints = 6;

/// The robot on its base joints: link 0 is a world without mass, which must not move; link
/// kNumBaseJoints is the robot's root. Joints, links and contacts keep their order and names; their
/// indices grow by kNumBaseJoints. Pairs, ignored collisions and gaits are left out.
models::RobotModel OnBaseJoints(const models::RobotModel& robot);

}  // namespace possibility::dynamics
