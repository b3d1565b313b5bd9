#include "models/robot/actuator.h"

#include <algorithm>
#include <cmath>

namespace possibility::models {

double Actuator::Friction(double speed) const {
  return viscous_friction * speed + dry_friction * std::tanh(speed / dry_speed);
}

double Actuator::FrictionSlope(double speed) const {
  const double sign = std::tanh(speed / dry_speed);
  return viscous_friction + dry_friction * (1 - sign * sign) / dry_speed;
}

double Actuator::FrictionCurvature(double speed) const {
  const double sign = std::tanh(speed / dry_speed);
  return -2 * dry_friction * sign * (1 - sign * sign) / (dry_speed * dry_speed);
}

double Actuator::GreatestFrictionCurvature() const {
  // Of 2 x (1 - x^2), at x = 1 / sqrt(3).
  const double greatest = 4 / (3 * std::sqrt(3.0));
  return greatest * dry_friction / (dry_speed * dry_speed);
}

double Actuator::Limit(double effort, double torque, double speed) const {
  if (!line) return effort;
  const double forward = torque < 0 ? -speed : speed;
  return std::clamp(line->stall_torque * (1 - forward / line->no_load_speed), 0.0, effort);
}

double Actuator::Limit(double effort, double speed) const {
  return Limit(effort, 1, std::abs(speed));
}

}  // namespace possibility::models
