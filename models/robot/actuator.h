#pragma once

#include <optional>

namespace possibility::models {

/// The straight line on which a direct-current motor's torque falls with its speed, seen at the
/// joint: stall_torque (1 - speed / no_load_speed) at most. Torques against the motion may be
/// greater.
struct TorqueSpeedLine {
  double stall_torque = 0;   ///< N m or N, > 0
  double no_load_speed = 0;  ///< rad/s or m/s, > 0
};

/// The motor and gear of a joint, seen at the joint (docs/dynamics.md, "Actuators"). The motor
/// bears
///   tau = inverse dynamics of the links + armature a + viscous_friction v
///         + dry_friction tanh(v / dry_speed).
/// By default it delivers any torque within the joint's effort limit, and nothing else.
struct Actuator {
  double armature = 0;          ///< rotor inertia times gear ratio squared, kg m^2 or kg, >= 0
  double viscous_friction = 0;  ///< N m s/rad or N s/m, >= 0
  double dry_friction = 0;      ///< N m or N, >= 0
  /// rad/s or m/s, > 0: width of the smooth change of sign of the dry friction. 76 % of it act at
  /// this speed.
  double dry_speed = 0.1;
  std::optional<TorqueSpeedLine> line;

  /// Whether it adds torques to those of the links.
  bool HasLosses() const { return armature > 0 || viscous_friction > 0 || dry_friction > 0; }
  /// Torque that friction takes at a speed, N m or N.
  double Friction(double speed) const;
  double FrictionSlope(double speed) const;      ///< its first derivative
  double FrictionCurvature(double speed) const;  ///< its second derivative
  /// Bound of the second derivative at all speeds.
  double GreatestFrictionCurvature() const;
  /// The greatest magnitude, >= 0, of a torque with the sign of `torque` at this speed. `effort`:
  /// the joint's limit at rest.
  double Limit(double effort, double torque, double speed) const;
  /// The lesser of the limits of both signs.
  double Limit(double effort, double speed) const;
};

}  // namespace possibility::models
