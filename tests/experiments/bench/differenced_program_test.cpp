#include "experiments/bench/differenced_program.h"

#include <gtest/gtest.h>

#include <random>

#include "collocation/solver/solver.h"
#include "collocation/transcription/transcription.h"
#include "experiments/problems/regression_problems.h"

namespace possibility::experiments {
namespace {

using Eigen::VectorXd;

VectorXd RandomPoint(const collocation::NonlinearProgram& program, const VectorXd& guess,
                     std::mt19937* random) {
  std::uniform_real_distribution<double> uniform(-0.2, 0.2);
  VectorXd x = guess;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    x[i] = std::clamp(x[i] + uniform(*random), program.lower()[i], program.upper()[i]);
  }
  return x;
}

/// Compared with the exact Jacobian, for every problem of the suite.
TEST(DifferencedProgram, JacobianAgreesWithTheExactOne) {
  std::mt19937 random(3);
  for (const RegressionProblem& problem : RegressionProblems()) {
    const auto posed = problem.build();
    collocation::Transcription program(
        *posed, problem.scheme,
        std::vector<collocation::Mesh>(posed->num_phases(), collocation::UniformMesh(6)));
    const VectorXd guess = program.InitialGuess();
    DifferencedProgram differenced(&program, guess);
    const int entries = program.jacobian_pattern().size();
    for (int trial = 0; trial < 3; ++trial) {
      const VectorXd x = RandomPoint(program, guess, &random);
      VectorXd exact(entries), approximate(entries);
      program.Jacobian(x, &exact);
      differenced.Jacobian(x, &approximate);
      if (!exact.allFinite()) continue;  // where a function is not defined
      for (int k = 0; k < entries; ++k) {
        ASSERT_NEAR(approximate[k], exact[k], 1e-4 * (1 + exact.cwiseAbs().maxCoeff()))
            << problem.name << ", entry " << k;
      }
    }
  }
}

TEST(DifferencedProgram, GroupsDoNotGrowWithTheMesh) {
  const auto problems = RegressionProblems();
  const auto found = std::find_if(problems.begin(), problems.end(),
                                  [](const auto& p) { return p.name == "cart_pole"; });
  ASSERT_NE(found, problems.end());
  const auto posed = found->build();
  std::vector<int> groups;
  for (const int intervals : {10, 40}) {
    collocation::Transcription program(*posed, collocation::HermiteSimpson(),
                                       {collocation::UniformMesh(intervals)});
    groups.push_back(DifferencedProgram(&program, program.InitialGuess()).num_groups());
  }
  EXPECT_EQ(groups[0], groups[1]);
  EXPECT_GT(groups[0], 0);
  EXPECT_LE(groups[0], 7);  // x, q and their rates and accelerations, and the force
}

TEST(DifferencedProgram, HasTheSameOptimum) {
  const auto problems = RegressionProblems();
  const auto found = std::find_if(problems.begin(), problems.end(), [](const auto& p) {
    return p.name == "linear_tangent_steering";
  });
  ASSERT_NE(found, problems.end());
  const auto posed = found->build();
  collocation::Transcription program(*posed, collocation::HermiteSimpson(),
                                     {collocation::UniformMesh(15)});
  const collocation::SolverGuess guess{program.InitialGuess(), {}, {}, {}};
  collocation::SolverOptions options;
  const auto exact = Solve(&program, guess, options);
  options.hessian = collocation::HessianMode::kLimitedMemory;
  DifferencedProgram differenced(&program, guess.x);
  const auto approximate = Solve(&differenced, guess, options);
  ASSERT_TRUE(exact.succeeded()) << exact.message;
  ASSERT_TRUE(approximate.succeeded()) << approximate.message;
  EXPECT_NEAR(approximate.objective, exact.objective, 1e-6);
}

}  // namespace
}  // namespace possibility::experiments
