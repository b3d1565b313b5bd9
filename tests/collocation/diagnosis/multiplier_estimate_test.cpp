#include "collocation/diagnosis/multiplier_estimate.h"

#include <gtest/gtest.h>

#include <random>

#include "collocation/solver/solver.h"
#include "tests/collocation/solver/quadratic_program.h"

namespace possibility::collocation {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// A convex program with its bounds near the unconstrained minimum.
QuadraticProgram ConvexWithBounds(std::mt19937* random) {
  const int n = 8, m = 4;
  const MatrixXd noise = NormalMatrix(n, n, random);
  QuadraticProgram program(noise * noise.transpose() + MatrixXd::Identity(n, n),
                           5 * NormalMatrix(n, 1, random), NormalMatrix(m, n, random));
  program.mutable_lower().setConstant(-0.5);
  program.mutable_upper().setConstant(0.5);
  program.mutable_upper()[2] = program.mutable_lower()[2];
  program.mutable_row_lower() << 0, -0.2, -kUnbounded, -3;
  program.mutable_row_upper() << 0, 0.2, 0.1, 3;
  return program;
}

TEST(MultiplierEstimateTest, AgreesWithIpoptAtASolution) {
  std::mt19937 random(2);
  for (int sample = 0; sample < 20; ++sample) {
    QuadraticProgram program = ConvexWithBounds(&random);
    SolverOptions options;
    options.tolerance = 1e-11;
    const SolverResult result = Solve(&program, {VectorXd::Zero(8), {}, {}, {}}, options);
    ASSERT_TRUE(result.succeeded()) << result.message;
    const MultiplierEstimate estimate = EstimateMultipliers(&program, result.x, 1e-6);
    EXPECT_LT(estimate.residual, 1e-5);
    EXPECT_LT((estimate.rows - result.constraint_multipliers).lpNorm<Eigen::Infinity>(), 1e-4);
    for (int i = 0; i < 8; ++i) {
      if (i == 2) continue;  // fixed: Ipopt leaves it out
      EXPECT_NEAR(estimate.lower[i], result.lower_multipliers[i], 1e-4);
      EXPECT_NEAR(estimate.upper[i], result.upper_multipliers[i], 1e-4);
    }
  }
}

TEST(MultiplierEstimateTest, ABoundThatWouldPullIsReleased) {
  // x = 0 at a lower bound, but the objective falls with x.
  QuadraticProgram program(MatrixXd::Identity(1, 1), -VectorXd::Ones(1), MatrixXd::Ones(1, 1));
  program.mutable_lower()[0] = 0;
  program.mutable_row_lower()[0] = 0;
  const MultiplierEstimate estimate = EstimateMultipliers(&program, VectorXd::Zero(1), 1e-6);
  EXPECT_EQ(estimate.residual, 1);
  EXPECT_EQ(estimate.lower[0], 0);
  EXPECT_EQ(estimate.rows[0], 0);
}

}  // namespace
}  // namespace possibility::collocation
