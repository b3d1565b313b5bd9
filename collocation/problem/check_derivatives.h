#pragma once

#include <Eigen/Core>
#include <vector>

#include "collocation/problem/function.h"

namespace possibility::collocation {

/// An element of a function's derivatives that disagrees with differences.
struct DerivativeFault {
  enum class Kind {
    kJacobian,      ///< row: output, column: argument
    kJacobianMask,  ///< outside the mask but not zero
    kHessian,       ///< row and column: arguments
    kHessianMask
  };

  Kind kind = Kind::kJacobian;
  int row = 0;
  int column = 0;
  /// The wrong output; -1: of a Hessian that is right for each output, but not for several
  /// together.
  int output = -1;
  double given = 0;        ///< NaN: the function did not write it
  double differenced = 0;  ///< the better known value, also outside the masks

  bool operator==(const DerivativeFault&) const = default;
};

struct DerivativeCheck {
  /// Of the greatest derivative of the same output.
  double tolerance = 1e-7;
  /// Typical sizes of the arguments; empty: 1. Steps are 1e-4 to 0.1 of them.
  Eigen::VectorXd sizes;
  /// For the Hessian of all outputs together; empty: some numbers of both signs.
  Eigen::VectorXd multipliers;
};

/// Compares a function's Jacobian, Hessian and masks at z with central differences, extrapolated to
/// step 0 (Richardson; Ridders 1982). The Hessian's differences are made of the Jacobian, so it is
/// compared only if the Jacobian is right. An element counts as wrong if the difference exceeds the
/// tolerance and is well above the differences' own estimated error. Where the function is defined
/// on one side only or has a kink, nothing is reported.
/// @throws what the function throws at z; std::invalid_argument if a size does not fit.
std::vector<DerivativeFault> CheckDerivatives(Function* f, const Eigen::VectorXd& z,
                                              const DerivativeCheck& check = {});

}  // namespace possibility::collocation
