#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "actions/plan/plan.h"
#include "dynamics/simbody/simbody_dynamics.h"
#include "models/robot/robot_model.h"

namespace possibility::actions {

/// One bearing point of a phase: a column of Knot::forces.
struct BearingPoint {
  int patch = 0;  ///< index into RobotModel::contacts
  int index = 0;  ///< within the patch
  int link = 0;
  Eigen::Vector3d p_L = Eigen::Vector3d::Zero();
};

/// The bearing points of a phase. @throws InputError if a contact is not the robot's.
std::vector<BearingPoint> BearingPoints(const models::RobotModel& robot, const Phase& phase);

/// "left_sole point 2".
std::string NameOf(const models::RobotModel& robot, const BearingPoint& point);

/// State of the robot at one instant, computed by Simbody.
struct VerifierState {
  Knot knot;
  std::vector<Eigen::Isometry3d> X_WL;
  std::vector<Eigen::Vector3d> w_WL;  ///< angular velocity of every link, world axes
  std::vector<Eigen::Vector3d> v_WL;  ///< velocity of every link's origin, world axes
  double max_speed = 0;               ///< m/s, upper bound for any point of any link

  Eigen::Vector3d Position(const BearingPoint& point) const { return X_WL[point.link] * point.p_L; }
  Eigen::Vector3d Velocity(const BearingPoint& point) const {
    return v_WL[point.link] + w_WL[point.link].cross(X_WL[point.link].linear() * point.p_L);
  }
};

/// Evaluates states on its own Simbody system: one per thread.
class StateEvaluator {
 public:
  explicit StateEvaluator(const models::RobotModel& robot);

  /// Leaves the dynamics at this state.
  VerifierState Evaluate(Knot knot);

  const dynamics::SimbodyDynamics& dynamics() const { return dynamics_; }

  /// Distance from a link's origin to the farthest point of its shapes, m (an upper bound).
  const std::vector<double>& link_radii() const { return link_radii_; }

 private:
  void PropagateVelocities(VerifierState* state) const;

  const models::RobotModel* robot_;
  dynamics::SimbodyDynamics dynamics_;
  std::vector<double> link_radii_;
};

}  // namespace possibility::actions
