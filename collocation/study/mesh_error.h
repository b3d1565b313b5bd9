#pragma once

#include "collocation/study/optimal_control.h"

namespace possibility::collocation {

/// Error of each interval of each phase: the integral, between the knots, of the residuals of the
/// equality constraints that hold everywhere (dynamics among them), divided by their scales; the
/// greatest over all rows.
std::vector<std::vector<double>> MeshErrors(const OptimalControlProblem& problem,
                                            const Trajectory& trajectory);

/// Splits the intervals whose error exceeds `tolerance` into as many parts as a scheme of that
/// order needs, at most 4.
Mesh Refined(const Mesh& mesh, const std::vector<double>& errors, double tolerance, int order);

}  // namespace possibility::collocation
