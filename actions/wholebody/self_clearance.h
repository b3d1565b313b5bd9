#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "models/robot/robot_model.h"
#include "models/world/collision.h"

namespace possibility::actions {

/// Distance that links keep from each other in motion, m.
inline constexpr double kSelfClearance = 0.01;

/// Tests the distances of links from each other. Links that are close to each other in a posture of
/// rest may come a little closer than there. Immutable: may be used in several threads.
class SelfClearance {
 public:
  struct Fault {
    models::Proximity pair;
    double required = 0;  ///< m
  };

  /// `robot` outlives this. `rests`: configurations in which it rests.
  SelfClearance(const models::RobotModel& robot, const std::vector<Eigen::VectorXd>& rests);

  /// Pairs of links that at q are closer than `clearance` (m, up to twice kSelfClearance) and than
  /// what the postures of rest allow.
  std::vector<Fault> Faults(const Eigen::VectorXd& q, double clearance) const;
  /// The same at poses of the links.
  std::vector<Fault> Faults(const std::vector<Eigen::Isometry3d>& X_WL, double clearance) const;

 private:
  std::vector<Eigen::Isometry3d> Poses(const Eigen::VectorXd& q) const;

  const models::RobotModel* robot_;
  models::CollisionChecker checker_;
  std::vector<models::Proximity> close_at_rest_;
};

}  // namespace possibility::actions
