#pragma once

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "dynamics/rollout/robot_rollout.h"
#include "models/robot/robot_model.h"

namespace possibility::dynamics {

inline models::Link LinkOf(const std::string& name, double mass, const Eigen::Vector3d& p_LC,
                           double inertia) {
  models::Link link;
  link.name = name;
  link.inertial.mass = mass;
  link.inertial.p_LC = p_LC;
  link.inertial.I_LC = inertia * Eigen::Matrix3d::Identity();
  return link;
}

/// The plane through the origin that falls by `slope` rad towards +x.
inline Eigen::Vector3d SlopeNormal(double slope) { return {std::sin(slope), 0, std::cos(slope)}; }

inline RolloutContact ContactOn(const std::string& name, int link, const Eigen::Vector3d& p_L,
                                const Eigen::Vector3d& normal) {
  RolloutContact contact;
  contact.name = name;
  contact.point = {link, p_L, normal};
  return contact;
}

/// A hub of mass 1 kg and inertia `inertia` with `spokes` spokes of `length`. The base is at the
/// hub, and spoke k points down at pitch -2 pi k / spokes.
inline std::shared_ptr<const MultibodyModel> RimlessWheel(double inertia) {
  models::RobotModel robot;
  robot.name = "rimless wheel";
  robot.links = {LinkOf("hub", 1, Eigen::Vector3d::Zero(), inertia)};
  return MultibodyModel::Planar(robot);
}

inline std::vector<RolloutContact> Spokes(int spokes, double length, double slope) {
  std::vector<RolloutContact> contacts;
  for (int k = 0; k < spokes; ++k) {
    // Down and, for a positive k, forward.
    const double angle = 2 * M_PI * k / spokes;
    contacts.push_back(ContactOn("spoke " + std::to_string(k), 0,
                                 length * Eigen::Vector3d(std::sin(angle), 0, -std::cos(angle)),
                                 SlopeNormal(slope)));
  }
  return contacts;
}

/// The compass gait as a tree. One leg with the hip's mass is the root (base at the hip), the other
/// leg hangs from it.
inline std::shared_ptr<const MultibodyModel> CompassTree(double leg_mass, double hip_mass,
                                                         double mass_to_hip) {
  models::RobotModel robot;
  robot.name = "compass";
  const double depth = leg_mass * mass_to_hip / (leg_mass + hip_mass);
  models::Link first = LinkOf("first leg", leg_mass + hip_mass, {0, 0, -depth}, 0);
  const double inertia = hip_mass * depth * depth + leg_mass * std::pow(mass_to_hip - depth, 2);
  first.inertial.I_LC.diagonal() << inertia, inertia, 0;
  robot.links = {first, LinkOf("second leg", leg_mass, {0, 0, -mass_to_hip}, 0)};
  models::Joint hip;
  hip.name = "hip";
  hip.type = models::JointType::kContinuous;
  hip.axis = Eigen::Vector3d::UnitY();
  hip.lower = -INFINITY;
  hip.upper = INFINITY;
  hip.velocity = 100;
  hip.effort = 100;
  robot.joints = {hip};
  return MultibodyModel::Planar(robot);
}

}  // namespace possibility::dynamics
