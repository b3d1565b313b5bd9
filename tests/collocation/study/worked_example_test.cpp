// The example of docs/collocation.md.
#include <gtest/gtest.h>

#include "collocation/study/optimal_control.h"

namespace possibility::collocation {
namespace {

TEST(WorkedExampleTest, BlockMoveMeetsItsClosedForm) {
  OptimalControlProblem problem("block move");
  Phase& move = problem.AddPhase("move", 2);
  const Variable x = move.AddCoordinate("x");
  const Variable u = move.AddControl("force", {-20, 20});
  move.SetDuration(1);
  move.SetDynamics(FunctionOf([](auto force) { return force; }), {u});
  for (const At end : {At::kStart, At::kEnd}) move.Fix(move.Rate(x), 0, end);
  move.Fix(x, 0, At::kStart);
  move.Fix(x, 1, At::kEnd);
  move.AddIntegralCost("effort", FunctionOf([](auto force) { return force * force; }), {u});

  const OptimalControlResult result = SolveOptimalControl(problem);
  ASSERT_TRUE(result.succeeded()) << result.message;
  EXPECT_NEAR(result.objective, 12, 1e-7);
  // x = 3 t^2 - 2 t^3
  EXPECT_NEAR(result.Value(x, 0.25), 0.15625, 1e-8);
  EXPECT_NEAR(result.Value(move.Rate(x), 0.25), 1.125, 1e-8);
  EXPECT_NEAR(result.Value(u, 0.25), 3, 1e-7);
  for (const auto& [name, violation] : result.violations) EXPECT_LT(violation.amount, 1e-8) << name;
}

}  // namespace
}  // namespace possibility::collocation
