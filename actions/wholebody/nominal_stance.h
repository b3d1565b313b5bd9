#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "actions/wholebody/planar_pose.h"
#include "models/robot/robot_model.h"

namespace possibility::actions {

/// A gait's nominal posture with its contacts brought exactly to the ground, in the stance frame S
/// (below the root: origin on the ground, x along the root's heading).
struct NominalStance {
  const models::Gait* gait = nullptr;
  Eigen::VectorXd q;                                ///< stance frame at the world's origin
  std::vector<Eigen::Vector3d> patch_centres;       ///< by limb, in S
  std::vector<Eigen::Matrix3d> patch_orientations;  ///< of the limbs' links, in S
  /// By limb: yaw in S of its patch's frame, rad; 0 if the limb does not hold its orientation.
  std::vector<double> patch_headings;
  std::vector<std::vector<Eigen::Vector2d>> bearing_points;  ///< by limb, in S
  Eigen::Vector2d centre_of_mass = Eigen::Vector2d::Zero();  ///< in S
  Eigen::Isometry3d X_SR = Eigen::Isometry3d::Identity();    ///< root link

  /// The root's pose when the robot stands at `stance` on ground of height z.
  Eigen::Isometry3d RootPose(const PlanarPose& stance, double z) const {
    return stance.At(z) * X_SR;
  }
};

/// @throws InputError if the joints of the gait's limbs cannot bring the posture's contacts to the
/// ground, or a joint leaves its limits.
NominalStance SolveNominalStance(const models::RobotModel& robot, const models::Gait& gait);

}  // namespace possibility::actions
