#include "collocation/problem/table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "tests/collocation/robot/exact_derivatives.h"
#include "tests/message_of.h"

namespace possibility::collocation {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

double ValueAt(Function* f, const VectorXd& z) {
  VectorXd y(1);
  f->Evaluate(z, &y);
  return y[0];
}

/// Knots at random distances.
VectorXd RandomKnots(int n, std::mt19937* random) {
  std::uniform_real_distribution<double> distance(0.2, 1);
  VectorXd knots(n);
  knots[0] = -distance(*random);
  for (int i = 1; i < n; ++i) knots[i] = knots[i - 1] + distance(*random);
  return knots;
}

double Cubic(double x) { return 0.3 - x + 0.7 * x * x - 0.4 * x * x * x; }
double Bicubic(double x, double y) { return Cubic(x) * Cubic(0.5 - y) + x * x * y; }

TEST(Table, PassesThroughItsValues) {
  std::mt19937 random(1);
  for (const int n : {4, 5, 9}) {
    const VectorXd knots = RandomKnots(n, &random);
    const VectorXd values = VectorXd::Random(n);
    const auto table = Table(knots, values);
    for (int i = 0; i < n; ++i) {
      EXPECT_NEAR(ValueAt(table.get(), knots.segment<1>(i)), values[i], 1e-13);
    }
  }
}

TEST(Table, CubicPolynomialsComeOutExactlyBeyondTheTableToo) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> place(-2, 6);
  for (const int n : {4, 7}) {
    const VectorXd x = RandomKnots(n, &random);
    const VectorXd y = RandomKnots(n + 1, &random);
    MatrixXd values(n, n + 1);
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j <= n; ++j) values(i, j) = Bicubic(x[i], y[j]);
    }
    const auto one = Table(x, x.unaryExpr(&Cubic));
    const auto two = Table(x, y, values);
    for (int trial = 0; trial < 50; ++trial) {
      const Eigen::Vector2d z(place(random), place(random));
      EXPECT_NEAR(ValueAt(one.get(), z.head<1>()), Cubic(z.x()), 1e-9);
      const double expected = Bicubic(z.x(), z.y());
      EXPECT_NEAR(ValueAt(two.get(), z), expected, 1e-9 * (1 + std::abs(expected)));
    }
  }
}

TEST(Table, DerivativesAgreeWithDifferences) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> share(0.05, 0.95);
  for (int trial = 0; trial < 20; ++trial) {
    const VectorXd x = RandomKnots(6, &random);
    const VectorXd y = RandomKnots(5, &random);
    // Away from knots: differences across one are less exact.
    const double at_x = x[trial % 5] + share(random) * (x[trial % 5 + 1] - x[trial % 5]);
    const double at_y = y[trial % 4] + share(random) * (y[trial % 4 + 1] - y[trial % 4]);
    ExpectExactDerivatives(Table(x, VectorXd::Random(6)).get(), VectorXd::Constant(1, at_x),
                           VectorXd::Random(1));
    ExpectExactDerivatives(Table(x, y, MatrixXd::Random(6, 5)).get(), Eigen::Vector2d(at_x, at_y),
                           VectorXd::Random(1));
  }
}

TEST(Table, SecondDerivativesAreContinuousAcrossKnots) {
  const VectorXd knots = VectorXd::LinSpaced(7, 0, 3);
  const auto table = Table(knots, VectorXd::Random(7));
  const VectorXd one = VectorXd::Ones(1);
  for (int i = 1; i < 6; ++i) {
    MatrixXd before(1, 1), after(1, 1);
    table->Hessian(knots.segment<1>(i).array() - 1e-9, one, &before);
    table->Hessian(knots.segment<1>(i).array() + 1e-9, one, &after);
    EXPECT_NEAR(before(0, 0), after(0, 0), 1e-6);
  }
}

TEST(Table, ThatIsNoneIsRefused) {
  const auto message = [](const VectorXd& knots, const VectorXd& values) {
    return MessageOf([&] { Table(knots, values); });
  };
  EXPECT_EQ(message(VectorXd::LinSpaced(3, 0, 1), VectorXd::Zero(3)),
            "table: 3 knots, expected 4 or more");
  EXPECT_EQ(message(VectorXd::LinSpaced(4, 0, 1), VectorXd::Zero(5)),
            "table: 5 values for 4 knots");
  EXPECT_EQ(message(Eigen::Vector4d(0, 2, 1, 3), VectorXd::Zero(4)),
            "table: knot 2 at 1 does not lie beyond the one before, at 2");
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(message(Eigen::Vector4d(0, 1, 2, infinity), VectorXd::Zero(4)),
            "table: a knot is not finite");
  EXPECT_EQ(message(VectorXd::LinSpaced(4, 0, 1), VectorXd::Constant(4, infinity)),
            "table: a value is not finite");
  EXPECT_EQ(MessageOf([] {
              Table(VectorXd::LinSpaced(4, 0, 1), VectorXd::LinSpaced(5, 0, 1),
                    MatrixXd::Zero(5, 4));
            }),
            "table: 5 x 4 values for 4 and 5 knots");
}

}  // namespace
}  // namespace possibility::collocation
