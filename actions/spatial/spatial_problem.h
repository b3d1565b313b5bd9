#pragma once

#include <Eigen/Core>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "actions/spatial/beam_clearance.h"
#include "collocation/problem/optimal_control_problem.h"
#include "collocation/robot/contact_sequence.h"
#include "collocation/robot/robot_phase.h"
#include "models/robot/contact_schedule.h"
#include "models/robot/robot_model.h"

namespace possibility::actions {

struct SpatialSettings {
  collocation::ContactSequenceSettings sequence;
  std::map<int, double> locked;  ///< joints of the robot that do not move, and their positions
  // How far the root may depart from the straight line between the two rests.
  double tilt = 0.2;  ///< rad, of roll and of pitch
  double turn = 0.2;  ///< rad, of yaw
  double rise = 0.1;  ///< m, upwards
  /// Of a stretched limb: longest distance of the joints next to its knee or elbow. A straight limb
  /// cannot follow.
  double reach = 0.985;
  std::optional<Beam> beam;       ///< to step over, in the world of the schedule
  double beam_clearance = 0.015;  ///< m, of the limbs from it
  // Weights of the integrals of squares, summed over joints, coordinates or force components.
  double torque_weight = 1;           ///< of (torque / 50 N m)^2
  double acceleration_weight = 0.01;  ///< of (acceleration / 10)^2; above 0
  double force_weight = 0.01;         ///< of (force / 400 N)^2
  double posture_weight = 0.3;        ///< of (joint's distance from the line between the rests)^2
  double time_weight = 0;             ///< of the duration, 1/s
};

/// A robot's motion through a contact schedule, from rest to rest, as an optimal-control problem.
struct SpatialProblem {
  std::unique_ptr<collocation::OptimalControlProblem> problem;
  collocation::RobotSystem model;
  std::vector<collocation::RobotPhase> phases;  ///< by interval of the schedule
};

/// `limbs`: a gait of `robot` whose limbs are to keep their reach. `from`, `to`: the rests, q of
/// `robot` (nq), in which the contacts of the first and the last
/// interval bear where the schedule has them. The guess is the line between the rests, carried
/// along with the contacts.
/// @throws std::invalid_argument as AddContactSequence, or if a rest has a wrong size.
SpatialProblem StateSpatialProblem(const models::RobotModel& robot, const models::Gait& limbs,
                                   const models::ContactSchedule& schedule,
                                   const Eigen::VectorXd& from, const Eigen::VectorXd& to,
                                   const SpatialSettings& settings);

}  // namespace possibility::actions
