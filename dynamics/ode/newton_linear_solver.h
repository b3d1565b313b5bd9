#pragma once

#include <sundials/sundials_linearsolver.h>

#include "dynamics/ode/newton_matrix.h"

namespace possibility::dynamics {

/// Hands `matrix` to SUNDIALS, which never sees its entries: whoever sets up the linear system
/// writes J there and calls SetGamma. Null if memory is short; to be freed with SUNLinSolFree.
/// `matrix` must outlive it.
SUNLinearSolver MakeNewtonLinearSolver(NewtonMatrix* matrix, SUNContext context);
void SetGamma(SUNLinearSolver solver, double gamma);

}  // namespace possibility::dynamics
