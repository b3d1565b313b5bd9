#pragma once

#include <Eigen/Geometry>

#include "actions/conditions/support_bound.h"
#include "models/robot/robot_model.h"
#include "models/world/ground_map.h"

namespace possibility::actions {

/// Where the contact points of one patch can be, seen from the root: a convex region that contains
/// every place that the joints between them allow. Necessary: other limbs, obstacles, balance and
/// torques may forbid most of it. The reachability condition of Tonneau et al. (2018), as an upper
/// bound.
class ReachableRegion {
 public:
  /// Some milliseconds. Coupled joints count as if each moved by itself.
  ReachableRegion(const models::RobotModel& robot, const models::ContactPatch& patch);

  /// At least the greatest d'p of any reachable point p; root frame, m.
  double Support(const Eigen::Vector3d& d) const { return support_(d); }

  /// False only if no contact point can be on the ground with the root at X_WR.
  bool MeetsGround(const models::GroundMap& ground, const Eigen::Isometry3d& X_WR) const;

 private:
  bool MeetsPlane(const models::GroundMap& ground, int plane, const Eigen::Isometry3d& X_WR) const;
  /// At least the greatest e'p of reachable points p with normal'p = offset; root frame.
  double SupportWithin(const Eigen::Vector3d& normal, double offset,
                       const Eigen::Vector3d& e) const;

  SupportBound support_;
  Eigen::Vector3d centre_R_;  ///< of a ball about the region
  double radius_ = 0;         ///< m, of that ball
};

}  // namespace possibility::actions
