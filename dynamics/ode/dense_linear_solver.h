#pragma once

#include <sundials/sundials_linearsolver.h>

namespace possibility::dynamics {

/// A SUNDIALS solver for dense systems by Eigen's LU with partial pivoting, which takes a fifth of
/// the time of SUNDIALS's own for 70 unknowns. Matrices: SUNDenseMatrix; vectors: serial. Null if
/// memory is short; to be freed with SUNLinSolFree.
SUNLinearSolver MakeDenseLinearSolver(SUNContext context);

}  // namespace possibility::dynamics
