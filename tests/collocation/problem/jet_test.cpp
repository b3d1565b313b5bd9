#include "collocation/problem/jet.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "collocation/problem/function.h"
#include "tests/collocation/robot/exact_derivatives.h"
#include "tests/dynamics/richardson.h"

namespace possibility::collocation {
namespace {

using dynamics::RelativeError;
using dynamics::RichardsonJacobian;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Every operation of a jet.
std::shared_ptr<Function> Everything() {
  return Differentiated<3, 4>([](const auto& z, auto* y) {
    auto sum = z[0];
    sum += z[1] * z[2];
    sum -= 2.0 * z[1];
    sum *= z[2];
    sum /= z[0] + 3.0;
    (*y)[0] = sum + sin(z[0] * z[1]) - cos(z[1] / z[2]);
    (*y)[1] = exp(-z[0]) * log(z[1] + 2.0) + sqrt(z[2] + 1.0) / (1.0 + Square(z[0]));
    (*y)[2] = tan(0.3 * z[0]) + atan(z[1]) * tanh(z[2]) - pow(z[1] + z[2], 2.5) / 3.0;
    (*y)[3] = z[0] < z[1] ? z[0] * z[0] : z[1] * z[2];
  });
}

TEST(JetTest, DerivativesAgreeWithDifferences) {
  constexpr double kStep = 2e-3;  // the functions bend sharply
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(0.3, 1.2);
  const auto f = Everything();
  for (int trial = 0; trial < 200; ++trial) {
    VectorXd z(3);
    for (double& x : z) x = uniform(random);
    if (std::abs(z[0] - z[1]) < 0.05) continue;  // the branch of the last output
    const VectorXd multipliers = VectorXd::Random(4);
    const auto value = [&](const VectorXd& d) {
      VectorXd y(4);
      f->Evaluate(z + d, &y);
      return y;
    };
    MatrixXd J(4, 3), H(3, 3);
    f->Jacobian(z, &J);
    EXPECT_LT(RelativeError(J, RichardsonJacobian(value, 3, kStep)), 1e-8);
    const auto gradient = [&](const VectorXd& d) {
      MatrixXd at(4, 3);
      f->Jacobian(z + d, &at);
      return VectorXd(at.transpose() * multipliers);
    };
    f->Hessian(z, multipliers, &H);
    EXPECT_LT(RelativeError(H, RichardsonJacobian(gradient, 3, kStep)), 1e-8);
    EXPECT_LT(RelativeError(H, H.transpose()), 1e-14);
  }
}

/// Functions whose domain is not that of Everything's.
std::shared_ptr<Function> Inverses() {
  return Differentiated<3, 6>([](const auto& z, auto* y) {
    (*y)[0] = asin(z[0] * z[1]) + acos(z[1] - z[2]);
    (*y)[1] = atan2(z[0] - 0.1, z[1] + z[2]);
    (*y)[2] = abs(z[0]) * z[1] + sinh(z[1]) * cosh(z[2]);
    (*y)[3] = pow(z[0] + 2.0, z[1]) - pow(z[2], 2.0) + pow(z[2], 1.0);
    (*y)[4] = SmoothMax(z[0], z[1] * z[2], 0.3);
    (*y)[5] = SmoothMin(z[0], z[1], 0.3);
  });
}

TEST(JetTest, InversesAndRoundedChoicesAgreeWithDifferences) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> uniform(-0.35, 0.35);
  const auto f = Inverses();
  for (int trial = 0; trial < 200; ++trial) {
    VectorXd z(3);
    for (double& x : z) x = uniform(random);
    const bool near_a_kink = std::abs(z[0]) < 0.05 || std::hypot(z[0] - 0.1, z[1] + z[2]) < 0.2 ||
                             (z[1] + z[2] < 0.05 && std::abs(z[0] - 0.1) < 0.05);
    if (near_a_kink) continue;
    ExpectExactDerivatives(f.get(), z, VectorXd::Random(6));
  }
}

TEST(JetTest, AnglesAreRightInAllQuadrants) {
  using J = Jet<2, 1>;
  for (double angle = -3.1; angle < 3.14; angle += 0.1) {
    const J a = atan2(J::Input(2 * std::sin(angle), 0), J::Input(2 * std::cos(angle), 1));
    EXPECT_NEAR(a.value, angle, 1e-14);
    EXPECT_NEAR(a.gradient[0], std::cos(angle) / 2, 1e-14);
    EXPECT_NEAR(a.gradient[1], -std::sin(angle) / 2, 1e-14);
  }
}

TEST(JetTest, PowersOfZeroHaveTheirDerivatives) {
  using J = Jet<1, 2>;
  const J x = J::Input(0, 0);
  EXPECT_EQ(pow(x, 1.0).gradient[0], 1);
  EXPECT_EQ(pow(x, 1.0).hessian(0, 0), 0);
  EXPECT_EQ(pow(x, 2.0).hessian(0, 0), 2);
  EXPECT_EQ(pow(x, 0.0).gradient[0], 0);
}

TEST(JetTest, RoundedChoicesBoundTheTrueOnes) {
  for (const double a : {-3.0, 0.0, 0.1, 2.0}) {
    for (const double b : {-1.0, 0.05, 7.0}) {
      EXPECT_GE(SmoothMax(a, b, 0.1), std::max(a, b));
      EXPECT_LE(SmoothMax(a, b, 0.1), std::max(a, b) + 0.05);
      EXPECT_LE(SmoothMin(a, b, 0.1), std::min(a, b));
    }
  }
}

TEST(FunctionOf, FindsTheSizesOfItsCode) {
  const auto product = FunctionOf([](auto a, auto b, auto c) { return a * sin(b) * c; });
  EXPECT_EQ(product->num_inputs(), 3);
  EXPECT_EQ(product->num_outputs(), 1);
  ExpectExactDerivatives(product.get(), Eigen::Vector3d(0.3, 0.7, -0.4), VectorXd::Ones(1));
  const auto polar = FunctionOf([](auto r, auto angle) {
    return std::array{r * cos(angle), r * sin(angle)};
  });
  EXPECT_EQ(polar->num_inputs(), 2);
  EXPECT_EQ(polar->num_outputs(), 2);
  VectorXd y(2);
  polar->Evaluate(Eigen::Vector2d(2, 0), &y);
  EXPECT_EQ(y, Eigen::Vector2d(2, 0));
  ExpectExactDerivatives(polar.get(), Eigen::Vector2d(1.2, 0.5), Eigen::Vector2d(0.7, -1.1));
}

TEST(JetTest, HasTheHandComputedDerivatives) {
  using J2 = Jet<2, 2>;
  const J2 x = J2::Input(2, 0);
  const J2 y = J2::Input(3, 1);
  const J2 f = x * x * y / (y - 1.0);
  EXPECT_DOUBLE_EQ(f.value, 6);
  EXPECT_DOUBLE_EQ(f.gradient[0], 6);     // 2 x y / (y - 1)
  EXPECT_DOUBLE_EQ(f.gradient[1], -1);    // -x^2 / (y - 1)^2
  EXPECT_DOUBLE_EQ(f.hessian(0, 0), 3);   // 2 y / (y - 1)
  EXPECT_DOUBLE_EQ(f.hessian(0, 1), -1);  // -2 x / (y - 1)^2
  EXPECT_DOUBLE_EQ(f.hessian(1, 1), 1);   // 2 x^2 / (y - 1)^3
}

}  // namespace
}  // namespace possibility::collocation
