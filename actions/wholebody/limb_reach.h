#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "actions/wholebody/nominal_stance.h"
#include "actions/wholebody/planar_pose.h"
#include "models/robot/robot_model.h"

namespace possibility::actions {

/// How far a limb reaches if its joints before and after the bend (limb_bend.h) stay as in the
/// nominal posture.
struct LimbReach {
  Eigen::Vector3d hip = Eigen::Vector3d::Zero();  ///< the joint before the bend, from the root
  Eigen::Vector3d ankle =
      Eigen::Vector3d::Zero();  ///< where the part after it ends, from the patch's centre
  double length = 0;            ///< m, greatest distance of the two

  /// Height of the root at which the limb is stretched, m; none if its place is out of reach from
  /// every height. `root`: seen from above. `centre`: of the patch, world; `turned`: axes of the
  /// stance frame that the patch stands in.
  std::optional<double> HighestRoot(const PlanarPose& root, const Eigen::Vector3d& centre,
                                    const Eigen::Matrix3d& turned) const;
};

/// By limb; none for limbs without a bend. `stretch`: share of the straight limb's length; less
/// where the bend's range does not let it be straight.
std::vector<std::optional<LimbReach>> ReachesOf(const models::RobotModel& robot,
                                                const NominalStance& stance, double stretch);

}  // namespace possibility::actions
