#include "actions/rollout/perturbation.h"

#include <cmath>
#include <numbers>

namespace possibility::actions {
namespace {

using Eigen::AngleAxisd;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kPushDuration = 0.1;  // s

}  // namespace

Matrix3d Perturbation::Tilt() const {
  return (AngleAxisd(side_slope, Vector3d::UnitX()) * AngleAxisd(-slope, Vector3d::UnitY()))
      .toRotationMatrix();
}

models::RobotModel Perturbation::Perturbed(models::RobotModel robot) const {
  for (models::Link& link : robot.links) {
    link.inertial.mass *= mass;
    link.inertial.I_LC *= mass;
  }
  for (models::Joint& joint : robot.joints) {
    joint.effort *= torque;
    if (joint.actuator.line) joint.actuator.line->stall_torque *= torque;
  }
  if (armature > 0) {
    for (const int joint : robot.LegJoints()) robot.joints[joint].actuator.armature += armature;
  }
  robot.friction = friction.value_or(robot.friction);
  return robot;
}

Vector3d Perturbation::PushAt(double t, double begin, double end) const {
  const double start = begin + push_share * (end - begin) - kPushDuration / 2;
  const double s = (t - start) / kPushDuration;
  if (s <= 0 || s >= 1) return Vector3d::Zero();
  const double force =
      push * std::numbers::pi / (2 * kPushDuration) * std::sin(std::numbers::pi * s);
  return force * Vector3d(std::cos(push_direction), std::sin(push_direction), 0);
}

}  // namespace possibility::actions
