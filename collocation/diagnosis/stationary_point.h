#pragma once

#include "collocation/problem/nonlinear_program.h"
#include "collocation/solver/solver.h"
#include "common/cancellation_token.h"

namespace possibility::collocation {

/// What a point is that meets the first-order conditions.
enum class StationaryPoint {
  kUnknown,  ///< neither is proved: a flat direction, or bounds that hold without a force
  kMinimum,  ///< a strict local minimum
  kSaddle    ///< no minimum: feasible points beside it have a lower objective, to second order
};

/// "unknown", "minimum" or "saddle".
const char* StationaryPointName(StationaryPoint point);

/// Second-order conditions at the point and multipliers of a successful solve with exact Hessian;
/// any other result is kUnknown. Eigenvalues of the Hessian that are smaller than the accuracy of
/// the solve (options.tolerance) prove nothing. docs/collocation.md has the method.
/// @throws Cancelled.
StationaryPoint ClassifyStationaryPoint(NonlinearProgram* program, const SolverResult& result,
                                        const SolverOptions& options,
                                        const CancellationToken& cancellation = {});

}  // namespace possibility::collocation
