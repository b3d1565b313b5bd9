#pragma once

#include "collocation/study/optimal_control.h"

namespace possibility::collocation {

/// Per interval of each phase: the integral of how far the equality constraints that hold
/// everywhere (dynamics among them) are from zero between the knots, divided by their scales;
/// the greatest of the rows.
std::vector<std::vector<double>> MeshErrors(const OptimalControlProblem& problem,
                                            const Trajectory& trajectory);

/// Splits the intervals whose error exceeds `tolerance` into as many parts as a scheme of that
/// order needs, up to 4.
Mesh Refined(const Mesh& mesh, const std::vector<double>& errors, double tolerance, int order);

}  // namespace possibility::collocation
