#include <gtest/gtest.h>

#include "collocation/transcription/transcription.h"
#include "experiments/problems/regression_problems.h"
#include "tests/dynamics/random_robot.h"

namespace possibility::experiments {
namespace {

/// At each problem's own guess, robots included.
TEST(RegressionProblems, DerivativesOfEveryProblemAgreeWithDifferences) {
  int problems = 0;
  for (const RegressionProblem& entry : RegressionProblems(dynamics::DrcHubo())) {
    const auto problem = entry.build();
    const std::vector<collocation::Mesh> meshes(problem->num_phases(), collocation::UniformMesh(4));
    const collocation::Transcription program(*problem, entry.scheme, meshes);
    for (const std::string& wrong : program.WrongDerivatives(program.InitialGuess())) {
      ADD_FAILURE() << entry.name << ": " << wrong;
    }
    ++problems;
  }
  EXPECT_GT(problems, 60);
}

}  // namespace
}  // namespace possibility::experiments
