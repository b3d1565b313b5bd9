#pragma once

#include <Eigen/Core>
#include <string>
#include <utility>
#include <vector>

#include "models/robot/robot_model.h"

namespace possibility::models {

/// Joints that are each other's mirror images in the plane y = 0 of the root's frame, at zero.
struct MirrorPairs {
  struct Pair {
    int left = 0, right = 0;  ///< joints; left has the greater y
    /// The right joint's value that mirrors a value 1 of the left one: 1 or -1.
    double sign = 1;
  };
  std::vector<Pair> pairs;
  std::vector<int> unpaired;  ///< joints that are neither in a pair nor in the plane
  /// Greatest distance of a joint from the mirror image of its partner, or from the plane, m, and
  /// the link that it moves.
  double worst_distance = 0;
  std::string worst_link;
  /// Greatest difference of two links' masses, kg, and the left one.
  double worst_mass = 0;
  std::string worst_mass_link;

  /// The robot mirrored: joints (num_joints) as the other side has them.
  Eigen::VectorXd Mirrored(const Eigen::VectorXd& joints) const;
};

/// Pairs joints from the root outwards: two joints of one type, on the same link or on links of a
/// pair, of which one is within `tolerance` (m) of the other's mirror image and whose axes mirror
/// each other to 0.1 rad. For joints that turn, places along the axis do not matter, unless there
/// are several: the nearest is taken.
MirrorPairs FindMirrorPairs(const RobotModel& robot, double tolerance);

/// Distance from symmetry above which a robot is said not to be symmetric, m.
inline constexpr double kSymmetric = 1e-3;

}  // namespace possibility::models
