#pragma once

#include <Eigen/Core>

#include "actions/conditions/locomotion_model.h"
#include "actions/wholebody/planar_pose.h"
#include "models/world/ground_map.h"

namespace possibility::actions {

/// False only if no stance of `gait` at height `z` (m), displaced from `pose` by up to `place` (m)
/// and turned by up to `turn` (rad) to either side, has ground under all its bearing points.
bool GroundMayHold(const LocomotionModel& model, const models::GroundMap& ground, int gait,
                   const PlanarPose& pose, double z, double place, double turn);

/// Sufficient: true only if GroundMayHold is true for every stance displaced from `pose` by up to
/// `displaced`, m.
bool GroundMayHoldAllAround(const LocomotionModel& model, const models::GroundMap& ground, int gait,
                            const PlanarPose& pose, double z, double place, double turn,
                            double displaced);

/// A box of launch stances of a manoeuvre and of their displacements, about its middle.
struct LaunchBox {
  struct End {
    int gait = 0;
    double z = 0;  ///< m
  };
  End launch;
  End landing;
  PlanarPose middle = {};                                       ///< of the launch stances
  Eigen::Vector2d half_place = Eigen::Vector2d::Zero();         ///< m
  double half_heading = 0;                                      ///< rad
  PlanarPose displacement = {};                                 ///< middle of the displacements
  Eigen::Vector2d half_displacement = Eigen::Vector2d::Zero();  ///< m, in the launch stance
  double half_turn = 0;                                         ///< rad
};

/// False only if no launch of the box both stands and lands on ground. Branch and bound: halves the
/// box along its widest dimension, at most `halvings` times in a row.
bool MayLand(const LocomotionModel& model, const models::GroundMap& ground, const LaunchBox& box,
             int halvings);

}  // namespace possibility::actions
