#pragma once

#include "collocation/solver/nonlinear_solver.h"

namespace possibility::experiments {

/// NLopt's SLSQP (Kraft, ACM TOMS 20, 1994): sequential quadratic programming with dense matrices
/// and a Hessian built from gradients, so that it shares no numerical method with Ipopt. Only where
/// NLopt is installed (POSSIBILITY_WITH_NLOPT is defined).
///
/// Multipliers are estimated at the end (EstimateMultipliers). With them, a result is solved if its
/// gradients balance to 1e-6 of the objective's or to the options' tolerance, if that is larger,
/// and acceptable at 100 times that. SLSQP compares objectives, so half of the digits is what it
/// can do. `max_iterations` counts gradients. Cancelling and the time limit act between
/// evaluations, not within the dense linear algebra. Solve refuses more than kMostSlsqpVariables
/// with std::invalid_argument, and Ipopt's own options.
inline constexpr int kMostSlsqpVariables = 2000;
const collocation::NonlinearSolver& SlsqpSolver();

}  // namespace possibility::experiments
