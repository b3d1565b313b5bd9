#pragma once

#include <Eigen/Core>
#include <memory>

#include "collocation/problem/optimal_control_problem.h"

namespace possibility::experiments {

/// A periodic step of FiveLinkBiped, whose root stands still at the stance foot.
struct BipedStep {
  static constexpr int kAngles = 5;  ///< pitch of the stance shank, then the joints
  using Angles = Eigen::Vector<double, kAngles>;

  double length;         ///< m
  double duration;       ///< s, in the source's gravity
  bool knees_bend_back;  ///< and never forward
  Angles first;          ///< where the guess begins
};

/// The least integral of squared torques over a step that ends with a rigid impact.
std::unique_ptr<collocation::OptimalControlProblem> FiveLinkStep(const BipedStep& step);

}  // namespace possibility::experiments
