#pragma once

#include "actions/plan/plan.h"
#include "actions/rollout/perturbation.h"
#include "actions/rollout/rollout_drift.h"
#include "actions/rollout/rollout_reference.h"
#include "common/cancellation_token.h"
#include "models/robot/robot_model.h"
#include "models/world/ground_map.h"

namespace possibility::actions {

struct PerturbedRolloutSettings {
  RolloutGains gains;
  double settling_time = 0.5;  ///< s, hold time of the last posture if the motion ends at rest
  double sample_time = 0.005;  ///< s, between compared states
  double tolerance = 1e-6;     ///< of the integrator: relative, and absolute of configurations
  /// Of the integrator: absolute, m/s and rad/s. A twentieth of CompliantGround::slip_speed; with a
  /// tenth and more, drifts differ by millimetres.
  double velocity_tolerance = 1e-5;
  /// Departures during the motion, torque and sliding, a tenth of the time. Whether the robot falls
  /// and how it ends are known without them.
  bool compares = true;
  CancellationToken cancellation;  ///< asked before every step
};

/// The same as RollOutSegment for a perturbed robot, on compliant ground with Coulomb friction:
/// feet may slide. A fall ends the simulation.
RolloutDrift RollOutPerturbed(const Segment& segment, const models::RobotModel& robot,
                              const models::GroundMap& ground, const Perturbation& perturbation,
                              const PerturbedRolloutSettings& settings = {});

}  // namespace possibility::actions
