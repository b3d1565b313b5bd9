#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>

#include "models/robot/robot_model.h"

namespace possibility::actions {

/// How a simulated robot and its ground differ from those of the plan. By default not at all.
struct Perturbation {
  double mass = 1;                 ///< factor on all masses and inertias
  double slope = 0;                ///< rad: the ground rises along the world's x
  double side_slope = 0;           ///< rad: the ground rises along the world's y
  double torque = 1;               ///< factor on the effort limits
  double armature = 0;             ///< kg m^2: added to the joints of the legs
  std::optional<double> friction;  ///< coefficient of the ground
  double push = 0;                 ///< N s: impulse on the root's centre of mass
  double push_direction = 0;       ///< rad, from the world's x
  double push_share = 0.5;         ///< of the motion's duration, at the middle of the push

  /// Turns the planned ground into the simulated one, about the place where the motion begins.
  Eigen::Matrix3d Tilt() const;
  /// The robot with the perturbed masses, limits, armatures and friction.
  models::RobotModel Perturbed(models::RobotModel robot) const;
  /// Force of the push, N: half a sine of 0.1 s. `begin`, `end`: of the motion, s.
  Eigen::Vector3d PushAt(double t, double begin, double end) const;
};

}  // namespace possibility::actions
