#pragma once

#include "actions/plan/plan.h"
#include "actions/rollout/rollout_drift.h"
#include "actions/rollout/rollout_reference.h"
#include "common/cancellation_token.h"
#include "models/robot/robot_model.h"
#include "models/world/ground_map.h"

namespace possibility::actions {

struct RolloutCheckSettings {
  RolloutGains gains;
  double settling_time = 0.5;  ///< s, hold time of the last posture if the motion ends at rest
  double sample_time = 0.005;  ///< s, between compared states
  double tolerance = 1e-8;     ///< of the integrator: relative, and absolute of configurations
  double velocity_tolerance = 5e-5;  ///< of the integrator: absolute, m/s and rad/s
  bool measures_torque = true;       ///< RolloutDrift::torque_used, a twelfth of the time
  CancellationToken cancellation;    ///< asked before every step
};

/// Simulates the robot from the initial state of `segment`, with the plan's torques and joint
/// feedback alone (the root's pose is not fed back), on rigid ground at the heights at which the
/// plan bears. The simulation decides about contacts, not the plan. Errors are reported in
/// RolloutDrift::failure. `segment`: must fit the robot's sizes and contacts (CheckStructure).
RolloutDrift RollOutSegment(const Segment& segment, const models::RobotModel& robot,
                            const models::GroundMap& ground,
                            const RolloutCheckSettings& settings = {});

}  // namespace possibility::actions
