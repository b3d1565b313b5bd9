#pragma once

#include <Eigen/Core>
#include <limits>
#include <vector>

#include "actions/plan/contact_name.h"
#include "dynamics/tree/tree_kinematics.h"
#include "experiments/viewer/viewer_momentum.h"

namespace possibility::experiments {

/// What says whether the robot falls, in the world. Not a number where there is none: in flight,
/// and while the ground carries less than a thousandth of the weight.
struct BalanceState {
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

  /// Zero moment point (actions::ZeroMomentPoint), m; z: mean height of the ground under the load.
  Eigen::Vector3d zmp = Eigen::Vector3d::Constant(kNone);
  double margin = kNone;  ///< of the zmp: actions::SupportMargin, m
  /// Instantaneous capture point, m (Pratt, Carff, Drakunov and Goswami 2006): c + c'/omega with
  /// the centre of mass c, omega^2 = g / (c_z - zmp_z). A linear inverted pendulum that puts its
  /// foot there comes to rest above it.
  Eigen::Vector2d capture = Eigen::Vector2d::Constant(kNone);
};

/// `kinematics`: at the knot's position. `forces`: of the knot. `whole`: at the knot.
BalanceState BalanceStateAt(const std::vector<actions::BearingPatch>& bearing,
                            const Eigen::Matrix3Xd& forces, const CentroidalState& whole,
                            const dynamics::TreeKinematics& kinematics);

}  // namespace possibility::experiments
