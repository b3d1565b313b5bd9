#pragma once

#include <vector>

#include "collocation/problem/optimal_control_problem.h"
#include "collocation/robot/point_functions.h"
#include "collocation/robot/robot_phase.h"
#include "models/robot/contact_schedule.h"

namespace possibility::collocation {

/// A point that stays on one side of a plane of another link: of two links on different sides of a
/// plane, none reaches the other.
struct Separation {
  PointOverPlane pair;
  double height = 0;  ///< m, least
  int interval = 0;   ///< of the schedule, in which it holds
};

struct ContactSequenceSettings {
  RobotLimits limits;
  /// Shortest and longest durations, as multiples of the schedule's; both 1 fix them.
  double quickest = 0.5;
  double slowest = 2;
  /// m: height of a swinging patch's points half-way, above the line from place to place.
  double clearance = 0.05;
  /// m: distance of each surface's centre of pressure from its edges.
  double pressure_reserve = 0;
  std::vector<Separation> separations;
  /// Whether the problem fixes positions, velocities and accelerations at the start of the first
  /// phase, and at the end of the last one. Then those of the patches that bear there are not
  /// stated a second time.
  bool start_is_fixed = true;
  bool end_is_fixed = true;
};

/// Adds a robot phase for each interval of a contact schedule, one after the other, to a problem.
/// Torques are controls. A patch that bears is held where the schedule has it; it lands without
/// speed, and bears nothing at the instants at which it lands and lifts. A patch that swings keeps
/// its clearance. The caller states the ends, the costs and the guess.
/// `model`: on joints (MultibodyModel::OnJoints), of the robot whose contacts the schedule names.
/// @throws std::invalid_argument naming the contact that the robot does not have, or as
/// CheckContactSchedule does.
std::vector<RobotPhase> AddContactSequence(OptimalControlProblem* problem, const RobotSystem& model,
                                           const models::ContactSchedule& schedule,
                                           const ContactSequenceSettings& settings);

}  // namespace possibility::collocation
