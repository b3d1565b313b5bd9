#pragma once

#include <memory>
#include <string>
#include <vector>

#include "collocation/problem/optimal_control_problem.h"
#include "dynamics/tree/contact_point.h"
#include "dynamics/tree/multibody_model.h"

namespace possibility::collocation {

/// Fractions of a robot's limits that a motion may use, and its largest accelerations. The rest is
/// a margin for what a plan does not model: forces between the knots, feedback, and, in the plane,
/// the robot's small asymmetries.
struct RobotLimits {
  double friction = 0.7;           ///< Coulomb
  double friction_fraction = 1;    ///< of `friction`
  double speed_fraction = 1;       ///< of the joints' speed limits
  double torque_fraction = 1;      ///< of the joints' effort limits and torque-speed lines
  double max_acceleration = 200;   ///< rad/s^2 and m/s^2, every coordinate
  double max_base_speed = 10;      ///< rad/s and m/s
  double min_normal_force = 0;     ///< N, at one contact point
  double max_normal_force = 2000;  ///< N, likewise
  double joint_margin = 0;         ///< rad or m, inside the joints' position limits
};

/// Who bears the torque limits.
enum class Torques {
  kRows,     ///< rows of the equation of motion: fewest variables
  kControls  ///< variables of their own, which costs may name
};

/// One phase of an optimal-control problem whose system is a robot, in its sagittal plane or in
/// space (Base::kPlanar, kJoints), in inverse-dynamics form: q, v, a and contact forces are
/// variables, and the equation of motion holds at every node.
struct RobotPhase {
  Phase* phase = nullptr;
  std::vector<Variable> q, v, a;               ///< nv each: base, joints
  std::vector<Variable> f;                     ///< the components of every point (ComponentsOf), N
  std::vector<Variable> torques;               ///< by joint, N m; empty for Torques::kRows
  std::vector<dynamics::ContactPoint> points;  ///< the points that bear

  /// q, or q and v, as arguments of PointPositions and PointVelocities.
  std::vector<Variable> Positions() const { return q; }
  std::vector<Variable> State() const;
  /// q, v and a, as arguments of PointAccelerations.
  std::vector<Variable> Motion() const;
};

/// Adds the phase with its dynamics, bounds and scales (q/1, v/5, a/50, f/400, torques/100). The
/// forces are constrained to their cones, in space to the greatest pyramid within them. The caller
/// must constrain the points not to move. The guess of the forces carries the weight.
RobotPhase AddRobotPhase(OptimalControlProblem* problem, const std::string& name,
                         const std::shared_ptr<const dynamics::MultibodyModel>& model,
                         const std::vector<dynamics::ContactPoint>& points,
                         const RobotLimits& limits, Torques torques = Torques::kRows);

/// The end of one phase and the start of the next share their positions, and their velocities
/// unless an impact lies between them.
void ContinueRobot(OptimalControlProblem* problem, const RobotPhase& from, const RobotPhase& to,
                   bool with_velocities);

/// Adds weight * integral of sum x^2 / scale^2.
void AddSquareCost(const std::string& name, const std::vector<Variable>& variables, double scale,
                   double weight, Phase* phase);

}  // namespace possibility::collocation
