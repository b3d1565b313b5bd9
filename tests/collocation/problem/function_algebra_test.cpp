#include "collocation/problem/function_algebra.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>

#include "tests/collocation/robot/exact_derivatives.h"

namespace possibility::collocation {
namespace {

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
    ExpectExactDerivatives(
        f.get(), VectorXd::NullaryExpr(4, [&] { return std::normal_distribution()(random); }),
        VectorXd::Random(2));
  }
}

TEST(LinearMap, IsTheMatrixWithItsMask) {
  std::mt19937 random(2);
  const MatrixXd B = Sparse(3, 5, &random);
  const auto f = LinearMap(B);
  const VectorXd z = VectorXd::Random(5);
  VectorXd y(3);
  f->Evaluate(z, &y);
  EXPECT_EQ(y, B * z);
  ExpectExactDerivatives(f.get(), z, VectorXd::Random(3));
  EXPECT_FALSE(f->HessianMask().any());
}

TEST(Composition, DerivativesAgreeWithDifferences) {
  std::mt19937 random(3);
  const auto outer = Differentiated<2, 3>([](const auto& y, auto* z) {
    (*z)[0] = y[0] * y[1] * y[1];
    (*z)[1] = sin(y[0]);
    (*z)[2] = y[1];
  });
  const auto f = Composition(outer, Inner());
  for (int trial = 0; trial < 50; ++trial) {
    ExpectExactDerivatives(
        f.get(), VectorXd::NullaryExpr(3, [&] { return std::normal_distribution()(random); }),
        VectorXd::Random(3));
  }
}

TEST(Composition, RefusesFunctionsThatDoNotFit) {
  EXPECT_THROW(Composition(Inner(), Inner()), std::invalid_argument);
}

TEST(SeparateSum, AddsTheFunctionsWithTheirDerivatives) {
  const auto angle = Differentiated<1, 2>([](const auto& z, auto* y) {
    (*y)[0] = cos(z[0]);
    (*y)[1] = z[0];
  });
  const auto sum = SeparateSum(Inner(), angle);
  const Eigen::Vector4d z(0.3, -0.7, 1.1, 0.4);
  Eigen::VectorXd y(2);
  sum->Evaluate(z, &y);
  EXPECT_DOUBLE_EQ(y[0], 0.3 * std::sin(-0.7) + std::cos(0.4));
  EXPECT_DOUBLE_EQ(y[1], -0.7 * 1.1 * 1.1 + 0.4);
  ExpectExactDerivatives(sum.get(), z, Eigen::Vector2d(0.8, -1.3));
  // Neither argument knows the other.
  EXPECT_FALSE(sum->HessianMask().topRightCorner(3, 1).any());
}

TEST(Stacked, HasTheOutputsOfBothWithTheirDerivatives) {
  const auto angle = Differentiated<1, 1>([](const auto& z, auto* y) { (*y)[0] = cos(z[0]); });
  const auto both = Stacked(Inner(), angle);
  const Eigen::Vector4d z(0.3, -0.7, 1.1, 0.4);
  Eigen::VectorXd y(3);
  both->Evaluate(z, &y);
  EXPECT_DOUBLE_EQ(y[1], -0.7 * 1.1 * 1.1);
  EXPECT_DOUBLE_EQ(y[2], std::cos(0.4));
  ExpectExactDerivatives(both.get(), z, Eigen::Vector3d(0.8, -1.3, 0.7));
  EXPECT_FALSE(both->JacobianMask().topRightCorner(2, 1).any());
  EXPECT_FALSE(both->HessianMask().topRightCorner(3, 1).any());
}

TEST(SeparateSum, RefusesFunctionsOfDifferentSizes) {
  const auto one = Differentiated<1, 1>([](const auto& z, auto* y) { (*y)[0] = z[0]; });
  EXPECT_THROW(SeparateSum(Inner(), one), std::invalid_argument);
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
}  // namespace possibility::collocation
