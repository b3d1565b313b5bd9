#pragma once

#include <Eigen/Core>

#include "actions/plan/plan.h"
#include "dynamics/tree/tree_kinematics.h"

namespace possibility::experiments {

/// Centre of mass and momentum of the robot, world axes.
struct CentroidalState {
  Eigen::Vector3d position;  ///< of the centre of mass, m
  Eigen::Vector3d linear;    ///< momentum, N s
  Eigen::Vector3d angular;   ///< momentum about the centre of mass, N m s
};

/// The sums over all links. `kinematics` must be the robot's.
CentroidalState CentroidalStateAt(const actions::Knot& knot, dynamics::TreeKinematics* kinematics);

}  // namespace possibility::experiments
