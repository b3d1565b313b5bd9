#include "collocation/problem/jet.h"

#include <gtest/gtest.h>

#include <functional>
#include <random>
#include <vector>

#include "collocation/problem/function.h"
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
