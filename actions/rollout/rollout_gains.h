#pragma once

#include <Eigen/Core>

#include "models/robot/robot_model.h"

namespace possibility::actions {

/// Joint feedback of the simulated robot.
struct RolloutGains {
  /// rad or m: joint error at which feedback alone would demand the full effort.
  double full_effort_error = 0.02;
  double damping_time = 0.03;  ///< s, damping over stiffness
  /// Least stiffness of the legs' joints, in multiples of weight times height of the root.
  double standing_stiffness = 8;
  /// num_joints, N m/rad or N/m, instead of what follows from the above; empty: not used.
  Eigen::VectorXd stiffness;
};

/// num_joints, N m/rad or N/m; 0 for joints without a limit of effort. A robot of mass m that
/// stands h high on one joint of stiffness k is a pendulum of rate^2 (k / (m g h) - 1) g/h. If k
/// follows from the effort alone, weak ankles let it sway as slowly as it steps, and every step
/// adds to the sway. The legs are the limbs of the robot's first gait.
/// @throws std::invalid_argument if gains.stiffness has a wrong size.
Eigen::VectorXd JointStiffness(const models::RobotModel& robot, const RolloutGains& gains);

}  // namespace possibility::actions
