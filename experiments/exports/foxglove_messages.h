#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <vector>

#include "experiments/samples/plan_samples.h"
#include "models/robot/robot_model.h"
#include "models/world/environment.h"

namespace possibility::experiments {

// Messages as JSON texts. Lengths and angles have six decimals, quaternions seven, forces three.
// `time`: ns.

/// Ground and obstacles in the frame "world", each an entity.
std::string WorldScene(const models::Environment& environment, std::uint64_t time);

/// The shapes of every link in its own frame.
std::string RobotScene(const models::RobotModel& robot, std::uint64_t time);

/// The frame of every link in that of the link that carries it, of the root in "world".
/// `X_WL`: by link.
std::string LinkTransforms(const models::RobotModel& robot,
                           const std::vector<Eigen::Isometry3d>& X_WL, std::uint64_t time);

/// Positions, velocities and torques of all joints.
std::string JointStates(const models::RobotModel& robot, const actions::Knot& knot,
                        std::uint64_t time);

/// A force of the ground on the robot; no force where the point does not bear.
struct PointForce {
  std::string name;
  bool bears = false;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< world, m
  Eigen::Vector3d force = Eigen::Vector3d::Zero();     ///< world, N
};

/// Arrows of one millimetre per newton at all points that bear.
std::string ForceArrows(const std::vector<PointForce>& forces, std::uint64_t time);
std::string ContactForces(const std::vector<PointForce>& forces, std::uint64_t time);

}  // namespace possibility::experiments
