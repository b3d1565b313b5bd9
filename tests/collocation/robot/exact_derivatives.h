#pragma once

#include <gtest/gtest.h>

#include "collocation/problem/function.h"
#include "tests/dynamics/richardson.h"

namespace possibility::collocation {

/// Jacobian, Hessian and their masks, against differences.
inline void ExpectExactDerivatives(Function* f, const Eigen::VectorXd& z,
                                   const Eigen::VectorXd& multipliers) {
  constexpr double kTolerance = 1e-7;
  const auto value = [&](const Eigen::VectorXd& d) {
    Eigen::VectorXd y(f->num_outputs());
    f->Evaluate(z + d, &y);
    return y;
  };
  Eigen::MatrixXd J(f->num_outputs(), f->num_inputs());
  f->Jacobian(z, &J);
  EXPECT_LT(dynamics::RelativeError(J, dynamics::RichardsonJacobian(value, f->num_inputs())),
            kTolerance);
  const Mask jacobian_mask = f->JacobianMask();
  EXPECT_EQ(J, Eigen::MatrixXd(jacobian_mask.select(J.array(), 0.0)));

  const auto gradient = [&](const Eigen::VectorXd& d) {
    Eigen::MatrixXd at(f->num_outputs(), f->num_inputs());
    f->Jacobian(z + d, &at);
    return Eigen::VectorXd(at.transpose() * multipliers);
  };
  Eigen::MatrixXd H(f->num_inputs(), f->num_inputs());
  f->Hessian(z, multipliers, &H);
  EXPECT_LT(dynamics::RelativeError(H, dynamics::RichardsonJacobian(gradient, f->num_inputs())),
            kTolerance);
  EXPECT_LT(dynamics::RelativeError(H, H.transpose()), 1e-13);
  const Mask hessian_mask = f->HessianMask();
  const Eigen::MatrixXd masked = hessian_mask.select(H.array(), 0.0);
  EXPECT_LE((H - masked).cwiseAbs().maxCoeff(), 1e-12 * H.cwiseAbs().maxCoeff());
}

}  // namespace possibility::collocation
