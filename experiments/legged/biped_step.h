#pragma once

#include <Eigen/Core>
#include <memory>

#include "collocation/problem/optimal_control_problem.h"

namespace possibility::experiments {

/// A periodic step of FiveLinkBiped, with its root fixed at the stance foot.
struct BipedStep {
  static constexpr int kAngles = 5;  ///< pitch of the stance shank, then the joints
  using Angles = Eigen::Vector<double, kAngles>;

  double length;         ///< m
  double duration;       ///< s, in the source's gravity
  bool knees_bend_back;  ///< knees never bend forward
  Angles first;          ///< start of the initial guess
};

/// Minimises the integral of squared torques over a step that ends with a rigid impact.
std::unique_ptr<collocation::OptimalControlProblem> FiveLinkStep(const BipedStep& step);

}  // namespace possibility::experiments
