#pragma once

#include <gtest/gtest.h>

#include "collocation/problem/check_derivatives.h"

namespace possibility::collocation {

/// Jacobian, Hessian and their masks, against differences.
inline void ExpectExactDerivatives(Function* f, const Eigen::VectorXd& z,
                                   const Eigen::VectorXd& multipliers) {
  DerivativeCheck check;
  check.multipliers = multipliers;
  for (const DerivativeFault& fault : CheckDerivatives(f, z, check)) {
    ADD_FAILURE() << (fault.kind == DerivativeFault::Kind::kJacobian ||
                              fault.kind == DerivativeFault::Kind::kJacobianMask
                          ? "Jacobian"
                          : "Hessian")
                  << " (" << fault.row << ", " << fault.column << "), output " << fault.output
                  << ": " << fault.given << ", differences give " << fault.differenced;
  }
}

}  // namespace possibility::collocation
