#pragma once

#include <Eigen/Geometry>
#include <utility>
#include <vector>

#include "models/robot/robot_model.h"
#include "models/world/collision.h"

namespace possibility::actions {

/// Collision geometry of C_N: the pelvis' own shapes, shrunk by more than the collision checker's
/// error, so that a pelvis that is not free is certainly in collision.
class PelvisClearance {
 public:
  /// `checker` must outlive this object.
  PelvisClearance(const models::RobotModel& robot, const models::CollisionChecker& checker);

  bool IsFree(const Eigen::Isometry3d& X_WR) const;

 private:
  const models::CollisionChecker* checker_;
  std::vector<std::pair<models::PreparedShape, Eigen::Isometry3d>> parts_;
};

}  // namespace possibility::actions
