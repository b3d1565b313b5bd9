#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "actions/onboarding/robot_draft.h"

namespace possibility::actions {

/// Joints of one leg that bring its sole to a place, with the root at the origin.
class FootPlacement {
 public:
  /// `side`: 0 left, 1 right. `draft` must outlive this.
  FootPlacement(const RobotDraft& draft, int side);

  /// Values of the leg's joints with the sole's centre at `centre` (m, in the root's frame), level
  /// and pointing ahead as at zero; the knee bends forward where it can. Damped least squares from
  /// many starts; of the solutions the one nearest to zero. None if there is no solution at least
  /// `margin` (rad) inside the limits. `joints`: all the others.
  std::optional<Eigen::VectorXd> Solve(const Eigen::Vector3d& centre, double margin,
                                       const Eigen::VectorXd& joints) const;

  /// The same, from one start.
  std::optional<Eigen::VectorXd> SolveFrom(const Eigen::Vector3d& centre, double margin,
                                           const Eigen::VectorXd& joints,
                                           const Eigen::VectorXd& start) const;

  /// Why Solve finds none: the joint that would leave its limits most, or that the leg is too
  /// short.
  std::string WhyNot(const Eigen::Vector3d& centre, double margin,
                     const Eigen::VectorXd& joints) const;

 private:
  double Forwardness(const Eigen::VectorXd& leg, const Eigen::VectorXd& joints) const;

  const RobotDraft* draft_;
  const std::vector<int>* leg_;
  const models::ContactPatch* patch_;
  Eigen::Matrix3d R_RL_;  ///< of the foot, level
  int knee_ = -1;         ///< index into the leg's joints; -1: none found
};

}  // namespace possibility::actions
