#pragma once

#include <functional>
#include <string>

#include "actions/plan/plan.h"
#include "models/robot/robot_model.h"
#include "models/world/ground_map.h"

namespace possibility::actions {

struct RolloutCheckSettings {
  /// rad or m: error of a joint at which feedback alone would ask for its whole effort.
  double full_effort_error = 0.02;
  double damping_time = 0.03;  ///< s, damping over stiffness
  double settling_time = 0.5;  ///< s, for which the last posture is held if the motion ends at rest
  double sample_time = 0.005;  ///< s, between the states that are compared
  double tolerance = 1e-8;     ///< of the integrator, relative and absolute
  std::function<bool()> stop;  ///< asked before every step; true gives up. May be empty
};

/// How a simulation departs from the motion that it was to follow.
struct RolloutDrift {
  double start = 0;              ///< s, of the motion
  double end = 0;                ///< s, likewise
  double worst_position = 0;     ///< m, of the root, while the motion lasts
  double worst_orientation = 0;  ///< rad, likewise
  double worst_joint = 0;        ///< rad or m, likewise
  double end_position = 0;       ///< m, of the root, once settled
  double end_orientation = 0;    ///< rad, likewise
  double end_speed = 0;          ///< m/s or rad/s, the greater of the root's, likewise
  bool ends_at_rest = false;     ///< the motion does, so that the simulation has to
  int impacts = 0;               ///< instants at which something hit the ground
  std::string failure;           ///< one line, why there is no end to compare; empty if there is

  /// Whether the robot ends near where it should, at rest if it should be.
  bool follows() const;
};

/// Bounds of RolloutDrift::follows.
inline constexpr double kRolloutPosition = 0.05;    // m
inline constexpr double kRolloutOrientation = 0.1;  // rad
inline constexpr double kRolloutSpeed = 0.05;       // m/s and rad/s

/// Whether a motion needs more than standing on something all the time: flight or impacts.
bool IsDynamic(const Phase& phase);
bool IsDynamic(const Segment& segment);

/// Simulates the robot from the state in which `segment` begins, with the plan's torques and
/// feedback of its joints alone (nothing knows where the root is), on the ground at the heights at
/// which the plan bears. Contacts come and go as the simulation has it, not the plan. Whatever goes
/// wrong is told by RolloutDrift::failure.
/// `segment`: of the robot's sizes and contacts (CheckStructure).
RolloutDrift RollOutSegment(const Segment& segment, const models::RobotModel& robot,
                            const models::GroundMap& ground,
                            const RolloutCheckSettings& settings = {});

}  // namespace possibility::actions
