#include "experiments/problems/linear_extension.h"

#include <gtest/gtest.h>

#include <random>
#include <stdexcept>

namespace possibility::experiments {
namespace {

using collocation::Differentiated;
using collocation::Function;
using Eigen::MatrixXd;
using Eigen::VectorXd;

std::shared_ptr<Function> Inner() {
  return Differentiated<3, 2>([](const auto& z, auto* y) {
    (*y)[0] = z[0] * sin(z[1]);
    (*y)[1] = z[1] * z[2] * z[2];
  });
}

/// Half of the elements are zero, so that the masks have something to exclude.
MatrixXd Sparse(int rows, int columns, std::mt19937* random) {
  std::normal_distribution<double> normal;
  MatrixXd matrix(rows, columns);
  for (double& element : matrix.reshaped()) element = (*random)() % 2 == 0 ? 0 : normal(*random);
  return matrix;
}

TEST(LinearExtension, DerivativesAgreeWithDifferences) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 50; ++trial) {
    const auto f = LinearExtension(Inner(), Sparse(3, 4, &random), Sparse(2, 4, &random));
    const VectorXd z = VectorXd::NullaryExpr(4, [&] { return std::normal_distribution()(random); });
    const VectorXd multipliers = VectorXd::Random(2);
    MatrixXd J(2, 4), H(4, 4);
    f->Jacobian(z, &J);
    f->Hessian(z, multipliers, &H);
    constexpr double kStep = 1e-5;
    for (int i = 0; i < 4; ++i) {
      VectorXd above = z, below = z, y_above(2), y_below(2);
      above[i] += kStep;
      below[i] -= kStep;
      f->Evaluate(above, &y_above);
      f->Evaluate(below, &y_below);
      EXPECT_LT(((y_above - y_below) / (2 * kStep) - J.col(i)).norm(), 1e-7);
      MatrixXd J_above(2, 4), J_below(2, 4);
      f->Jacobian(above, &J_above);
      f->Jacobian(below, &J_below);
      const VectorXd row = (J_above - J_below).transpose() * multipliers / (2 * kStep);
      EXPECT_LT((row - H.col(i)).norm(), 1e-7);
    }
    EXPECT_EQ((!f->JacobianMask() && J.array() != 0).count(), 0);
    EXPECT_EQ((!f->HessianMask() && H.array() != 0).count(), 0);
  }
}

TEST(LinearExtension, IsTheSumOfTheFunctionAndALinearTerm) {
  MatrixXd A = MatrixXd::Zero(3, 2), B = MatrixXd::Zero(2, 2);
  A << 1, 0, 0, 1, 1, 1;
  B(0, 1) = 5;
  VectorXd y(2);
  LinearExtension(Inner(), A, B)->Evaluate(Eigen::Vector2d(2, 0.5), &y);
  EXPECT_DOUBLE_EQ(y[0], 2 * std::sin(0.5) + 2.5);
  EXPECT_DOUBLE_EQ(y[1], 0.5 * 2.5 * 2.5);
}

TEST(LinearExtension, RefusesMatricesOfTheWrongSize) {
  const MatrixXd A = MatrixXd::Zero(3, 4), B = MatrixXd::Zero(2, 4);
  EXPECT_NO_THROW(LinearExtension(Inner(), A, B));
  EXPECT_THROW(LinearExtension(Inner(), A.topRows(2), B), std::invalid_argument);
  EXPECT_THROW(LinearExtension(Inner(), A, B.topRows(1)), std::invalid_argument);
  EXPECT_THROW(LinearExtension(Inner(), A, B.leftCols(3)), std::invalid_argument);
}

}  // namespace
}  // namespace possibility::experiments
