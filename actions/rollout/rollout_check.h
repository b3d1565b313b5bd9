#pragma once

#include <optional>
#include <string>

#include "actions/plan/plan.h"
#include "actions/rollout/perturbation.h"
#include "common/cancellation_token.h"
#include "models/robot/robot_model.h"
#include "models/world/ground_map.h"

namespace possibility::actions {

struct RolloutCheckSettings {
  /// rad or m: joint error at which feedback alone would demand the full effort.
  double full_effort_error = 0.02;
  double damping_time = 0.03;  ///< s, damping over stiffness
  double settling_time = 0.5;  ///< s, hold time of the last posture if the motion ends at rest
  double sample_time = 0.005;  ///< s, between compared states
  double tolerance = 1e-8;     ///< of the integrator: relative, and absolute of configurations
  double velocity_tolerance = 1e-5;  ///< of the integrator: absolute, m/s and rad/s
  CancellationToken cancellation;    ///< asked before every step
  Perturbation perturbation;         ///< of the simulated robot and ground
  bool measures_friction = false;    ///< takes a quarter longer
};

/// Deviation of a simulation from its reference motion.
struct RolloutDrift {
  double start = 0;              ///< s, of the motion
  double end = 0;                ///< s, likewise
  double worst_position = 0;     ///< m, of the root, during the motion
  double worst_orientation = 0;  ///< rad, likewise
  double worst_joint = 0;        ///< rad or m, likewise
  double end_position = 0;       ///< m, of the root, once settled
  double end_orientation = 0;    ///< rad, likewise
  double end_speed = 0;          ///< m/s or rad/s, the root's greater one, likewise
  bool ends_at_rest = false;     ///< the motion does, so the simulation must
  int impacts = 0;               ///< number of instants with impacts on the ground
  double torque_used = 0;        ///< greatest |torque| over effort limit
  /// Greatest tangential over normal force over friction of a patch that bears a fifth of the
  /// weight or more, in the mean over 20 ms; 0 unless it is measured.
  double friction_used = 0;
  std::optional<double> slipped_at;  ///< s: when it first exceeds 1
  /// Time of the motion, s, when the root first departs by kFallOrientation or kFallHeight.
  std::optional<double> fell_at;
  std::string failure;  ///< one line: why no end state exists; empty if it does

  /// Whether the simulation reaches its end and the robot neither falls nor slips.
  bool survives() const { return failure.empty() && !fell_at && !slipped_at; }
  /// Whether the robot ends near the motion's end, and at rest if the motion does.
  bool follows() const;
};

/// Bounds of RolloutDrift::follows.
inline constexpr double kRolloutPosition = 0.05;    // m
inline constexpr double kRolloutOrientation = 0.1;  // rad
inline constexpr double kRolloutSpeed = 0.05;       // m/s and rad/s
/// Bounds of RolloutDrift::fell_at.
inline constexpr double kFallOrientation = 0.5;  // rad
inline constexpr double kFallHeight = 0.2;       // m

/// Simulates the robot from the initial state of `segment`, with the plan's torques and joint
/// feedback alone (the root's pose is not fed back), on ground at the heights at which the plan
/// bears. The simulation decides about contacts, not the plan. Errors are reported in
/// RolloutDrift::failure. On tilted ground, the robot and its plan are tilted with it. `segment`:
/// must fit the robot's sizes and contacts (CheckStructure).
RolloutDrift RollOutSegment(const Segment& segment, const models::RobotModel& robot,
                            const models::GroundMap& ground,
                            const RolloutCheckSettings& settings = {});

}  // namespace possibility::actions
