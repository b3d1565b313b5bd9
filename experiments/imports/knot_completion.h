#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "actions/plan/plan.h"
#include "dynamics/tree/contact_point.h"
#include "dynamics/tree/multibody_dynamics.h"
#include "models/robot/robot_model.h"

namespace possibility::experiments {

/// Completes single instants of an imported motion. Conventions of q, v, a: models::RobotModel.
/// One per thread.
class KnotCompletion {
 public:
  /// `robot` must outlive it.
  explicit KnotCompletion(const models::RobotModel& robot);

  /// The velocity nearest to `v` at which the points rest and mimic joints follow.
  Eigen::VectorXd Resting(const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                          const std::vector<dynamics::ContactPoint>& points);

  /// The acceleration nearest to `a` at which the points do not accelerate, mimic joints follow,
  /// and forces at the points can balance the root: in flight the robot falls.
  Eigen::VectorXd Feasible(const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                           const Eigen::VectorXd& a,
                           const std::vector<dynamics::ContactPoint>& points);

  /// Sets tau and forces of a knot with q, v and a. Forces are the smallest in their cones with
  /// joint torques within their limits, at first with reserves; if there are none, the smallest
  /// that balance the root at all. `shares`: dynamics::ContactForceSettings.
  void SetForces(const std::vector<dynamics::ContactPoint>& points,
                 const std::vector<double>& shares, actions::Knot* knot);

  /// Impulses at the points that change the velocity from `before` to `after`, within the cones if
  /// possible; 3 x points, N s.
  Eigen::Matrix3Xd Impulses(const Eigen::VectorXd& q, const Eigen::VectorXd& before,
                            const Eigen::VectorXd& after,
                            const std::vector<dynamics::ContactPoint>& points);

  /// The velocity after an inelastic impact at which the points come to rest, and its impulses.
  struct Landing {
    Eigen::VectorXd velocity;
    Eigen::Matrix3Xd impulses;
  };
  Landing Land(const Eigen::VectorXd& q, const Eigen::VectorXd& before,
               const std::vector<dynamics::ContactPoint>& points);

 private:
  /// Rows of the points' Jacobians and of the mimic joints at the state set.
  Eigen::MatrixXd HeldRows(const std::vector<dynamics::ContactPoint>& points);
  /// 6 x 3 points: wrench on the root (torque, force) of forces at the points.
  Eigen::MatrixXd WrenchMap(const std::vector<dynamics::ContactPoint>& points) const;
  void SetTorques(const std::vector<dynamics::ContactPoint>& points, actions::Knot* knot);

  const models::RobotModel* robot_;
  dynamics::MultibodyDynamics dynamics_;  // every joint with a motor of its own
  std::vector<int> mimics_;               // joints
};

}  // namespace possibility::experiments
