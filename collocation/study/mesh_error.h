#pragma once

#include <vector>

#include "collocation/problem/optimal_control_problem.h"
#include "collocation/transcription/trajectory.h"

namespace possibility::collocation {

/// What a mesh interval hides between the points where the problem was imposed.
struct MeshError {
  /// Integral of the residuals of equality constraints (dynamics among them), divided by their
  /// scales; the greatest over all rows.
  double dynamics = 0;
  /// Integral of the integral costs along the motion, less the sum that was minimised, as a share
  /// of the objective or of the integral costs' magnitudes, whichever is greater.
  double cost = 0;
  /// Integral of what exceeds bounds of quantities or inequality constraints, divided by their
  /// scales; the greatest over all.
  double inequalities = 0;

  double Greatest() const;
};

/// By phase and interval. Errors are infinite where a function is undefined. `objective`: of the
/// trajectory. Constraints of single instants are left out.
std::vector<std::vector<MeshError>> MeshErrors(const OptimalControlProblem& problem,
                                               const Trajectory& trajectory, double objective);

/// Of each kind the greatest.
MeshError Worst(const std::vector<std::vector<MeshError>>& errors);

}  // namespace possibility::collocation
