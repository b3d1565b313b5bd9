#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "collocation/problem/function.h"
#include "dynamics/tree/multibody_dynamics.h"

namespace possibility::collocation {

/// A multibody system whose v is the rate of q (Base::kPlanar or kJoints), as functions of one
/// instant with exact first and second derivatives from dynamics/. q, v, a, f are stacked in that
/// order; f has one number per component of a contact point, N, on the robot. Each function keeps
/// its own workspace.
/// @throws std::invalid_argument if the model's base is a quaternion.
using RobotSystem = std::shared_ptr<const dynamics::MultibodyModel>;

/// One component of a point's position, velocity, acceleration or force.
struct PointComponent {
  dynamics::ContactPoint point;
  Eigen::Vector3d axis;  ///< unit, world
};

/// All components of each point that the system has: x and z in the plane; x, y and z in space.
std::vector<PointComponent> ComponentsOf(const dynamics::MultibodyModel& model,
                                         const std::vector<dynamics::ContactPoint>& points);

}  // namespace possibility::collocation
